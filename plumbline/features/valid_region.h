// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <Eigen/Core>

namespace plumbline {

// Region of real pixels of an image: rectification leaves borders that the camera did not see.
// Built once per camera from a mask, then queried for many positions in constant time.
class ValidRegion {
 public:
  // Every pixel of an image of this size is valid: only the image border limits.
  ValidRegion(int width, int height) : width_(width), height_(height) {}
  // Pixels of `mask` that are 0 are invalid. Cost: a few passes over the image.
  explicit ValidRegion(const GrayImage& mask);

  // Returns true if the square of half-width `radius` around the pixel has only valid pixels.
  bool Contains(const Eigen::Vector2d& px, double radius) const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_ = 0;
  int height_ = 0;
  GrayImage
      distance_;  // chessboard distance to the next invalid pixel, at most 255; empty: no mask
};

}  // namespace plumbline
