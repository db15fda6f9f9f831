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
  double offset_px = 1.2;  // across
  double gap = 0.15;       // relative to the shorter of the two
};

// Finds the lines of a set that lie on the same infinite line as another one, without looking at
// all: they are kept ordered by angle.
class CollinearIndex {
 public:
  explicit CollinearIndex(const std::vector<LineFeature>& lines);

  // Lines directed like `segment` whose midpoint is on its line, within the limits; ascending.
  std::vector<std::size_t> Near(const Segment2& segment, const LineMergeLimits& limits) const;

 private:
  struct Entry {
    double angle;
    std::size_t line;
    Eigen::Vector2d middle;
  };
  std::vector<Entry> entries_;  // by angle, then line
};

// The segment that covers both when b continues (or overlaps) a on the same straight edge: like
// direction, both ends of b close to the line of a, and the edge there in a gap between them too.
std::optional<Segment2> Join(const GradientImage& gradient,
                             const LineFeature& a,
                             const LineFeature& b,
                             const LineMergeLimits& limits);

}  // namespace plumbline
