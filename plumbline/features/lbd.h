// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/filters.h"

#include <array>
#include <vector>

namespace plumbline {

inline constexpr int kLbdBands = 9;
inline constexpr int kLbdBandWidth = 7;  // pixels

// 8 numbers for each band: the means of the four gradient sums, then their deviations. The means
// and the deviations are scaled to norm 1 each.
using LbdVector = std::array<float, static_cast<std::size_t>(8 * kLbdBands)>;

// Line band descriptor (Zhang and Koch, JVCIR 2013): gradients of 9 bands of 7 pixels parallel to
// the segment, in the frame (direction, normal) of the directed segment, summed over the rows of
// pixels by sign, weighted by a local and a global Gaussian across the line. Departures from the
// paper: rows are 2 pixels apart and have at most 96 samples; outside the image its border is
// repeated. `gradient` is that of the blurred image. A segment of zero length or outside the image
// gives all zeros. Cost: 2 to 5 microseconds.
LbdVector ComputeLbdVector(const GradientImage& gradient, const Segment2& segment);

// Returns 256 bits: for each of 32 pairs of bands, comparisons of their 8 numbers.
Descriptor BinarizeLbd(const LbdVector& vector);

// Sets the descriptors of lines.
void DescribeLines(const GradientImage& gradient, std::vector<LineFeature>* lines);

}  // namespace plumbline
