// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/segment.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Stretch kAll{-kInfinity, kInfinity}, kNone{kInfinity, -kInfinity};

// Returns the s with |offset + s step| <= radius.
Stretch InsideBall(const Eigen::Vector3d& offset, const Eigen::Vector3d& step, double radius) {
  const double a = step.squaredNorm(), b = offset.dot(step);
  const double c = offset.squaredNorm() - radius * radius;
  if (a == 0) return c <= 0 ? kAll : kNone;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kNone;
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

// Returns the s with 0 <= offset + s step <= limit.
Stretch Between(double offset, double step, double limit) {
  if (step == 0) return offset >= 0 && offset <= limit ? kAll : kNone;
  const double s0 = -offset / step, s1 = (limit - offset) / step;
  return {std::min(s0, s1), std::max(s0, s1)};
}

}  // namespace

Eigen::Vector3d LineThrough(const Segment2& segment) {
  const Eigen::Vector2d d = segment.Direction();
  const Eigen::Vector2d normal(-d.y(), d.x());
  return {normal.x(), normal.y(), -normal.dot(segment.Midpoint())};
}

double UndirectedAngle(const Eigen::Vector2d& direction1, const Eigen::Vector2d& direction2) {
  const double cross = direction1.x() * direction2.y() - direction1.y() * direction2.x();
  return math::Atan2(std::abs(cross), std::abs(direction1.dot(direction2)));
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

double UndirectedAngle(const Eigen::Vector3d& direction1, const Eigen::Vector3d& direction2) {
  return math::Atan2(direction1.cross(direction2).norm(), std::abs(direction1.dot(direction2)));
}

double Distance(const Segment3& segment, const Eigen::Vector3d& point) {
  const Eigen::Vector3d side = segment.end - segment.start;
  const double length2 = side.squaredNorm();
  if (length2 == 0) return (point - segment.start).norm();
  const double share = std::clamp(side.dot(point - segment.start) / length2, 0.0, 1.0);
  return (point - segment.start - share * side).norm();
}

std::optional<Stretch> StretchWithin(const Segment3& segment, const Segment3& axis, double radius) {
  const double length = segment.Length(), axis_length = axis.Length();
  const Eigen::Vector3d d = segment.Direction();
  const Eigen::Vector3d from_start = segment.start - axis.start;
  Stretch all = kNone;
  const auto add = [&all](const Stretch& part) {
    if (part.from > part.to) return;
    all = {std::min(all.from, part.from), std::max(all.to, part.to)};
  };
  add(InsideBall(from_start, d, radius));
  if (axis_length > 0) {
    add(InsideBall(segment.start - axis.end, d, radius));
    const Eigen::Vector3d u = axis.Direction();
    const Stretch around = InsideBall(from_start - from_start.dot(u) * u, d - d.dot(u) * u, radius);
    const Stretch along = Between(from_start.dot(u), d.dot(u), axis_length);
    add({std::max(around.from, along.from), std::min(around.to, along.to)});
  }
  const Stretch part{std::max(0.0, all.from), std::min(length, all.to)};
  if (part.from > part.to) return std::nullopt;
  return part;
}

std::vector<Stretch> CoveredAtLeast(std::span<const Stretch> stretches, int count) {
  return WellCovered(stretches, {}, count, 0);
}

std::vector<Stretch> WellCovered(std::span<const Stretch> stretches,
                                 std::span<const Stretch> expected,
                                 int count,
                                 double share) {
  // A parameter at which one of the two numbers changes. Begins come before ends, so that stretches
  // that touch are one.
  struct Event {
    double place;
    bool ends;
    int stretches, expected;
  };
  std::vector<Event> events;
  events.reserve(2 * (stretches.size() + expected.size()));
  for (const Stretch& stretch : stretches) {
    events.push_back({stretch.from, false, 1, 0});
    events.push_back({stretch.to, true, -1, 0});
  }
  for (const Stretch& stretch : expected) {
    events.push_back({stretch.from, false, 0, 1});
    events.push_back({stretch.to, true, 0, -1});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::pair(a.place, a.ends) < std::pair(b.place, b.ends);
  });
  std::vector<Stretch> parts;
  bool inside = false;
  int covered = 0, wanted = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    covered += events[i].stretches;
    wanted += events[i].expected;
    const bool more = i + 1 < events.size() && events[i + 1].place == events[i].place &&
                      events[i + 1].ends == events[i].ends;
    if (more) continue;  // first all that begins here, then all that ends here
    const bool enough = covered >= count && covered >= share * wanted;
    if (enough && !inside) parts.push_back({events[i].place, events[i].place});
    if (!enough && inside) parts.back().to = events[i].place;
    inside = enough;
  }
  return parts;
}

std::vector<Stretch> WithGapsClosed(std::span<const Stretch> parts, double max_gap) {
  std::vector<Stretch> closed;
  for (const Stretch& part : parts) {
    if (closed.empty() || part.from - closed.back().to > max_gap) {
      closed.push_back(part);
    } else {
      closed.back().to = part.to;
    }
  }
  return closed;
}

double TotalLength(std::span<const Stretch> stretches) {
  double sum = 0;
  for (const Stretch& stretch : stretches) sum += stretch.Length();
  return sum;
}

}  // namespace plumbline
