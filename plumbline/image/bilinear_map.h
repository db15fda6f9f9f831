// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstdint>
#include <vector>

namespace plumbline {

// Takes each pixel of an image from a place of another image, by linear interpolation between the
// four pixels around it. Places are rounded to 1/32 of a pixel. Beyond its border the other image
// is continued with the pixel there. The result is that of cv::remap to the last bit, in whole
// numbers.
class BilinearMap {
 public:
  // x, y: the place of each pixel in an image of width x height pixels. Places beyond +-131072
  // count as that far. Cost: some passes over the images, once.
  BilinearMap(const Image<float>& x, const Image<float>& y, int width, int height);

  // Maps an image, which must have the size to which the places refer (BugError otherwise). Cost:
  // about 2 ns a pixel.
  GrayImage Apply(const GrayImage& from) const;

 private:
  int from_width_, from_height_;
  int width_, height_;
  // For each pixel: the first of the four, and the weights in 32nds of those to the right of it and
  // below it.
  std::vector<std::int32_t> first_;
  std::vector<std::uint8_t> right_, below_;
};

}  // namespace plumbline
