// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/image/gradient.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

struct LineMergeLimits {
  double angle_deg = 1.5;
  double offset_px = 1.2;  // largest distance across the line
  double gap = 0.15;       // largest gap, relative to the shorter of the two
};

// Finds collinear lines of a set. Lines are sorted by angle, so that a query visits only a few.
class CollinearIndex {
 public:
  explicit CollinearIndex(const std::vector<LineFeature>& lines);

  // Returns the lines directed like `segment` whose midpoint is on its line, within the limits;
  // ascending.
  std::vector<std::size_t> Near(const Segment2& segment, const LineMergeLimits& limits) const;

 private:
  struct Entry {
    double angle;
    std::size_t line;
    Eigen::Vector2d middle;
  };
  std::vector<Entry> entries_;  // ordered by angle, then by line
};

// Returns the segment that covers both if b continues (or overlaps) a on the same straight edge:
// both have the same direction, both ends of b are close to the line of a, and the edge also exists
// in a gap between them.
std::optional<Segment2> Join(const GradientImage& gradient,
                             const LineFeature& a,
                             const LineFeature& b,
                             const LineMergeLimits& limits);

}  // namespace plumbline
