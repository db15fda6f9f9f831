// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <vector>

namespace plumbline {

// The pixels x0 to x1 - 1 of the rows y0 to y1 - 1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

struct FastCorner {
  int x = 0;
  int y = 0;
  float response = 0;  // the largest threshold at which the pixel is a corner, grey levels
};

// Finds FAST corners of one image (Rosten and Drummond 2006) at any threshold: 9 contiguous pixels
// of 16 on a circle are all brighter than the centre, or all darker, by more than the threshold.
// Equals cv::FAST with non-maximum suppression, but takes a fraction of its time for several
// thresholds: the contrast of each pixel is computed once, vectorized.
class FastCorners {
 public:
  static constexpr int kReach = 3;  // radius of the circle

  // Computes the contrast of the pixels of `area`, which must be at least kReach away from the
  // border. Cost: some 0.5 ns a pixel with AVX2, twice that without.
  FastCorners(const GrayImage& image, const PixelBox& area);

  // Appends, row by row, the corners in `part` of the area that exceed the threshold and are local
  // maxima within it.
  void Collect(const PixelBox& part, int threshold, std::vector<FastCorner>* corners) const;

 private:
  PixelBox area_;
  // For each pixel of the area, with a border of one pixel of 0: the least difference among the
  // best nine pixels.
  GrayImage contrast_;
};

}  // namespace plumbline
