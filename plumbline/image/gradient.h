// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>

namespace plumbline {

// First derivatives of an image by the 3x3 Sobel operator, 8 times the grey levels per pixel.
struct GradientImage {
  Image<std::int16_t> dx;
  Image<std::int16_t> dy;

  int width() const { return dx.width(); }
  int height() const { return dx.height(); }
};

inline constexpr double kSobelGain = 8;

// Returns the gradient of the image, after a Gaussian blur with `sigma` pixels if sigma > 0. Cost:
// two passes.
GradientImage ComputeGradient(const GrayImage& image, double sigma = 0);

}  // namespace plumbline
