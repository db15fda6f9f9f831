// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <span>
#include <vector>

namespace plumbline {

// Returns the intervals of a line covered by at least `count` of the stretches, disjoint and
// ascending; stretches that touch count as one. With count 1 this is the union. O(n log n).
std::vector<Stretch> CoveredAtLeast(std::span<const Stretch> stretches, int count);

// Returns the intervals covered by at least `count` of the stretches, and by at least `share` times
// as many of them as of `expected`: the parts of a line observed often enough, compared with the
// observations expected.
std::vector<Stretch> WellCovered(std::span<const Stretch> stretches,
                                 std::span<const Stretch> expected,
                                 int count,
                                 double share);

// Returns the parts with gaps of at most `max_gap` closed. `parts` must be disjoint and ascending.
std::vector<Stretch> WithGapsClosed(std::span<const Stretch> parts, double max_gap);

// Returns the sum of the lengths.
double TotalLength(std::span<const Stretch> stretches);

}  // namespace plumbline
