// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/gradient.h"

#include <array>
#include <vector>

namespace plumbline {

inline constexpr int kLbdBands = 9;
inline constexpr int kLbdBandWidth = 7;  // pixels

// 8 numbers for each band: mean, then deviation, of the four gradient sums; both halves scaled
// to 1.
using LbdVector = std::array<float, static_cast<std::size_t>(8 * kLbdBands)>;

// Line band descriptor (Zhang and Koch, JVCIR 2013): gradients of 9 bands of 7 pixels parallel to
// the segment, in the frame (direction, normal) of the directed segment, summed over the rows of
// pixels by sign, weighted by a local and a global Gaussian across the line. Departures: rows 2
// pixels apart, at most 96 samples on a row; outside the image its border goes on. `gradient` is
// that of the blurred image. A segment of zero length or outside the image gives all zeros. Cost: 2
// to 5 microseconds.
LbdVector ComputeLbdVector(const GradientImage& gradient, const Segment2& segment);

// 256 bits: for each of 32 pairs of bands, which of the two has the larger value in each of the 8
// numbers.
Descriptor BinarizeLbd(const LbdVector& vector);

// Fills in the descriptors.
void DescribeLines(const GradientImage& gradient, std::vector<LineFeature>* lines);

}  // namespace plumbline
