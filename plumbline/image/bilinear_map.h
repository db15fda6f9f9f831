// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// Resamples an image: each pixel is interpolated linearly between the four pixels around its source
// position, which is rounded to 1/32 of a pixel. The source image is continued with its border
// pixels. The result equals that of cv::remap to the last bit, in integers.
class BilinearMap {
 public:
  // x, y: source position of each pixel in an image of width x height pixels, clamped to +-131072.
  // Cost: some passes over the images, once.
  BilinearMap(const Image<float>& x, const Image<float>& y, int width, int height);

  // Maps an image, which must have the size given to the constructor (BugError otherwise). Cost:
  // about 2 ns a pixel.
  GrayImage Apply(const GrayImage& from) const;

 private:
  int from_width_, from_height_;
  int width_, height_;
  // For each pixel: the first of the four source pixels, and the weights in 32nds of those to its
  // right and below it.
  std::vector<std::int32_t> first_;
  std::vector<std::uint8_t> right_, below_;
};

}  // namespace plumbline
