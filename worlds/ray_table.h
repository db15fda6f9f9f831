// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The ray of every pixel of a camera, and its derivative across the pixel: the lens model is then
// evaluated once for a sequence instead of once for a sample. Rays end on the plane z = 1, or, of a
// lens of which a pixel sees more than 80 degrees off the axis, all have length 1.
class RayTable {
 public:
  // Pixels beyond the end of the lens have no ray. Throws InputError if the one in the middle of
  // the image is among them.
  explicit RayTable(const Camera& camera);

  struct Entry {
    Eigen::Vector3f ray = Eigen::Vector3f::UnitZ();  // at the centre of the pixel
    Eigen::Matrix<float, 3, 2> slope = Eigen::Matrix<float, 3, 2>::Zero();  // d(ray) / d(pixel)
    bool seen = false;  // the lens has a ray here; without one, `ray` has no meaning

    Eigen::Vector3f At(float dx, float dy) const { return ray + slope * Eigen::Vector2f(dx, dy); }
  };

  // Returns a direction as the table has rays: on the plane or of length 1. nullopt behind the
  // plane.
  std::optional<Eigen::Vector3d> Scaled(const Eigen::Vector3d& direction) const;

  int width() const { return width_; }
  int height() const { return height_; }
  const Entry& at(int x, int y) const {
    return entries_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }

 private:
  int width_ = 0, height_ = 0;
  bool on_plane_ = true;
  std::vector<Entry> entries_;
};

}  // namespace plumbline
