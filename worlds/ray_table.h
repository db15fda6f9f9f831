// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The ray of every pixel of a camera on the plane z = 1, and its derivative across the pixel: the
// lens model is then evaluated once for a sequence instead of once for a sample.
class RayTable {
 public:
  // Throws InputError if a pixel of the camera has no ray (distortion not invertible there).
  explicit RayTable(const Camera& camera);

  struct Entry {
    Eigen::Vector2f ray;    // x / z, y / z at the centre of the pixel
    Eigen::Matrix2f slope;  // d(ray) / d(pixel)

    Eigen::Vector2f At(float dx, float dy) const { return ray + slope * Eigen::Vector2f(dx, dy); }
  };

  int width() const { return width_; }
  int height() const { return height_; }
  const Entry& at(int x, int y) const {
    return entries_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace plumbline
