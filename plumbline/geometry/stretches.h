// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <span>
#include <vector>

namespace plumbline {

// The parts of a line that at least `count` of the stretches cover: disjoint, ascending, stretches
// that touch count as one. With count 1 their union. O(n log n).
std::vector<Stretch> CoveredAtLeast(std::span<const Stretch> stretches, int count);

// The parts covered by at least `count` of the stretches and by at least `share` times as many of
// them as of `expected`: where it was shown often enough of the times it should have been.
std::vector<Stretch> WellCovered(std::span<const Stretch> stretches,
                                 std::span<const Stretch> expected,
                                 int count,
                                 double share);

// Parts with gaps of at most `max_gap` closed. Parts: disjoint, ascending.
std::vector<Stretch> WithGapsClosed(std::span<const Stretch> parts, double max_gap);

// Sum of the lengths.
double TotalLength(std::span<const Stretch> stretches);

}  // namespace plumbline
