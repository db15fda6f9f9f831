// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A straight piece of a line with two end points. Segment2: pixels; Segment3: metres.
template <int kDim>
struct Segment {
  // Point in the space of the segment.
  using Vector = Eigen::Matrix<double, kDim, 1>;
  Vector start = Vector::Zero();
  Vector end = Vector::Zero();

  // Distance of the two ends.
  double Length() const { return (end - start).norm(); }
  // Unit vector from start to end; NaN if they are equal.
  Vector Direction() const { return (end - start).normalized(); }
  // The point half way between the ends.
  Vector Midpoint() const { return 0.5 * (start + end); }
  // The segment from end to start.
  Segment Reversed() const { return {end, start}; }
};

// A segment in an image, pixels.
using Segment2 = Segment<2>;
// A segment in space, metres.
using Segment3 = Segment<3>;

// Returns the infinite image line through a segment, l = (a, b, c) with a^2 + b^2 = 1, so that l .
// (x, y, 1) is the signed distance of a pixel from the line. (a, b) is the direction turned by +90
// degrees in image coordinates (x right, y down). Undefined for a segment of zero length.
Eigen::Vector3d LineThrough(const Segment2& segment);

// Signed distance of a pixel from a line l scaled to a^2 + b^2 = 1.
inline double LineDistance(const Eigen::Vector3d& line, const Eigen::Vector2d& px) {
  return line.x() * px.x() + line.y() * px.y() + line.z();
}

// Unsigned angle between two undirected image lines, radians in [0, pi/2].
double UndirectedAngle(const Eigen::Vector2d& direction1, const Eigen::Vector2d& direction2);

// Length of the part of `reference` that the orthogonal projection of `other` onto it covers,
// divided by the length of the shorter of the two; 0 when disjoint, up to 1.
double OverlapRatio(const Segment2& reference, const Segment2& other);

// Unsigned angle between two undirected lines in space, radians in [0, pi/2].
double UndirectedAngle(const Eigen::Vector3d& direction1, const Eigen::Vector3d& direction2);

// Distance of a point from the nearest point of a segment, metres.
double Distance(const Segment3& segment, const Eigen::Vector3d& point);

// An interval of a segment: from and to, metres from its start.
struct Stretch {
  double from = 0, to = 0;

  // Returns the length in metres.
  double Length() const { return to - from; }
};

// Returns the interval of `segment` within `radius` of `axis`, in any direction; nullopt if it is
// empty. Exact: it lies between the first and the last intersection of the segment with the
// cylinder around the axis and the balls around its ends, whose union is convex.
std::optional<Stretch> StretchWithin(const Segment3& segment, const Segment3& axis, double radius);

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
