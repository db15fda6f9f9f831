// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/image/filters.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// Returns the mean over the segment of the gradient's component along the image normal (-dy, dx) of
// LineThrough, in grey levels per pixel. Negative if the bright side is on the left.
double MeanNormalGradient(const GradientImage& gradient, const Segment2& segment);

// Moves the segment onto its edge. At up to 48 positions the steepest descent of grey level along
// the normal (-dy, dx) is found to sub-pixel by a parabola over the directional gradient, and a
// line is fitted with Tukey weights. The end points keep their positions along the segment. The
// segment must be directed with the bright side on its left and lie within `range_px` (1 to 7) of
// the edge. Returns nullopt if fewer than half of the positions show an edge on one line. Cost:
// about 2 microseconds.
std::optional<MeasuredSegment> RefineSegment(const GradientImage& gradient,
                                             const Segment2& segment,
                                             int range_px);

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
