// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

struct PyramidLevel {
  GrayImage image;
  // Full-size pixels per level pixel along x and y, from the actual (rounded) sizes.
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();

  // Pixel centres are at integers: full = (level + 0.5) * scale - 0.5.
  Eigen::Vector2d ToFull(const Eigen::Vector2d& px) const {
    return (px.array() + 0.5) * scale.array() - 0.5;
  }
  Eigen::Vector2d FromFull(const Eigen::Vector2d& px) const {
    return (px.array() + 0.5) / scale.array() - 0.5;
  }
};

// An image and smaller copies of it; level 0 has full size.
using ImagePyramid = std::vector<PyramidLevel>;

// Returns a pyramid. Each level is the level below resized (bilinear), so that level k is
// `factor`^k times smaller than level 0. It stops before a side would be shorter than `min_side`
// pixels; level 0 always exists.
ImagePyramid BuildPyramid(const GrayImage& image, int levels, double factor, int min_side = 40);

}  // namespace plumbline
