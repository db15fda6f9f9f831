// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_merging.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"
#include "plumbline/features/line_refinement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

double Angle(const Segment2& segment) {
  const Eigen::Vector2d d = segment.end - segment.start;
  return math::Atan2(d.y(), d.x());
}

}  // namespace

CollinearIndex::CollinearIndex(const std::vector<LineFeature>& lines) {
  entries_.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    entries_.push_back({Angle(lines[i].segment), i, lines[i].segment.Midpoint()});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.line < b.line;
  });
}

std::vector<std::size_t> CollinearIndex::Near(const Segment2& segment,
                                              const LineMergeLimits& limits) const {
  std::vector<std::size_t> near;
  const double angle = Angle(segment);
  const double width = limits.angle_deg * kDegree;
  const Eigen::Vector3d line = LineThrough(segment);
  const auto collect = [&](double from, double to) {
    auto entry =
        std::lower_bound(entries_.begin(), entries_.end(), from, [](const Entry& e, double limit) {
          return e.angle < limit;
        });
    for (; entry != entries_.end() && entry->angle <= to; ++entry) {
      if (std::abs(LineDistance(line, entry->middle)) <= limits.offset_px) {
        near.push_back(entry->line);
      }
    }
  };
  collect(angle - width, angle + width);
  // Angles wrap around at pi.
  constexpr double kTurn = 2 * std::numbers::pi;
  if (angle + width > std::numbers::pi) collect(-std::numbers::pi, angle + width - kTurn);
  if (angle - width < -std::numbers::pi) collect(angle - width + kTurn, std::numbers::pi);
  std::sort(near.begin(), near.end());
  return near;
}

std::optional<Segment2> Join(const GradientImage& gradient,
                             const LineFeature& a,
                             const LineFeature& b,
                             const LineMergeLimits& limits) {
  const Eigen::Vector2d direction = a.segment.Direction();
  if (direction.dot(b.segment.Direction()) < math::Cos(limits.angle_deg * kDegree)) {
    return std::nullopt;
  }
  const Eigen::Vector3d line = LineThrough(a.segment);
  if (std::abs(LineDistance(line, b.segment.start)) > limits.offset_px ||
      std::abs(LineDistance(line, b.segment.end)) > limits.offset_px) {
    return std::nullopt;
  }
  const double a_length = a.segment.Length();
  const double b0 = direction.dot(b.segment.start - a.segment.start);
  const double b1 = direction.dot(b.segment.end - a.segment.start);
  const double gap = std::max(b0 - a_length, -b1);
  if (gap > limits.gap * std::min(a_length, b.segment.Length())) return std::nullopt;
  if (gap > 2) {  // the edge must be there in the gap, too
    const Segment2 between = b0 > a_length ? Segment2{a.segment.end, b.segment.start}
                                           : Segment2{b.segment.end, a.segment.start};
    if (-MeanNormalGradient(gradient, between) < 0.4 * std::min(a.response, b.response)) {
      return std::nullopt;
    }
  }
  return Segment2{b0 < 0 ? b.segment.start : a.segment.start,
                  b1 > a_length ? b.segment.end : a.segment.end};
}

}  // namespace plumbline
