// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/image.h"

#include <vector>

namespace plumbline {

// A corner to describe: its pixel, and its orientation in radians.
struct OrientedPixel {
  int x = 0;
  int y = 0;
  double angle = 0;
};

inline constexpr int kOrbReach = 18;  // largest distance in pixels of a sample of the descriptor

// Computes steered BRIEF descriptors (Rublee et al., ICCV 2011, section 4) of pixels at least
// kOrbReach from the border: 256 comparisons of two grey levels around each, on the image smoothed
// over 7 x 7 pixels with a standard deviation of 2.
//
// The descriptors equal those of cv::ORB except for bits decided by rounding. OpenCV smooths the
// image in floating point, differently on each kind of processor; here integers give the same bits
// on all. Cost: about 0.5 ms for 1000 corners and a megapixel.
std::vector<Descriptor> DescribeOrb(const GrayImage& image,
                                    const std::vector<OrientedPixel>& corners);

}  // namespace plumbline
