// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/segment.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

Eigen::Vector3d LineThrough(const Segment2& segment) {
  const Eigen::Vector2d d = segment.Direction();
  const Eigen::Vector2d normal(-d.y(), d.x());
  return {normal.x(), normal.y(), -normal.dot(segment.Midpoint())};
}

double UndirectedAngle(const Eigen::Vector2d& direction1, const Eigen::Vector2d& direction2) {
  const double cross = direction1.x() * direction2.y() - direction1.y() * direction2.x();
  return std::atan2(std::abs(cross), std::abs(direction1.dot(direction2)));
}

double OverlapRatio(const Segment2& reference, const Segment2& other) {
  const Eigen::Vector2d d = reference.Direction();
  const double a = d.dot(other.start - reference.start);
  const double b = d.dot(other.end - reference.start);
  const double length = reference.Length();
  const double covered = std::min(length, std::max(a, b)) - std::max(0.0, std::min(a, b));
  const double shorter = std::min(length, std::abs(b - a));
  if (shorter <= 0) return 0;
  return std::clamp(covered / shorter, 0.0, 1.0);
}

}  // namespace plumbline
