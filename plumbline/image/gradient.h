// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>

#include <Eigen/Core>

namespace plumbline {

// First derivatives of an image by the 3x3 Sobel operator, 8 times the grey levels per pixel.
struct GradientImage {
  Image<std::int16_t> dx;
  Image<std::int16_t> dy;

  int width() const { return dx.width(); }
  int height() const { return dx.height(); }
};

inline constexpr double kSobelGain = 8;

// Gradient of the image, after a Gaussian blur with `sigma` pixels when sigma > 0. Cost: two
// passes.
GradientImage ComputeGradient(const GrayImage& image, double sigma = 0);

// Gradient at a sub-pixel position (bilinear), in grey levels per pixel. Zero outside the image.
Eigen::Vector2d GradientAt(const GradientImage& gradient, const Eigen::Vector2d& px);

// Grey level at a sub-pixel position (bilinear); the position is clamped to the image.
double IntensityAt(const GrayImage& image, const Eigen::Vector2d& px);

}  // namespace plumbline
