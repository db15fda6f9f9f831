// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_error.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/report/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

// A set of segments with an index for finding those close to another segment.
class SegmentSet {
 public:
  void Add(const Segment3& segment) {
    Eigen::AlignedBox3d box(segment.start);
    box.extend(segment.end);
    entries_.push_back({box, segment, segment.Direction()});
  }

  std::size_t size() const { return entries_.size(); }
  const Segment3& operator[](std::size_t i) const { return entries_[i].segment; }

  // Returns the segments of agreeing direction whose bounding box comes within the distance of the
  // segment's.
  std::vector<std::size_t> Near(const Segment3& segment, double distance, double max_angle) const {
    Eigen::AlignedBox3d box(segment.start);
    box.extend(segment.end);
    box.min().array() -= distance;
    box.max().array() += distance;
    const Eigen::Vector3d direction = segment.Direction();
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = entries_[i];
      if (!box.intersects(entry.box) || entry.segment.Length() == 0) continue;
      if (UndirectedAngle(direction, entry.direction) <= max_angle) near.push_back(i);
    }
    return near;
  }

 private:
  struct Entry {
    Eigen::AlignedBox3d box;
    Segment3 segment;
    Eigen::Vector3d direction;
  };

  std::vector<Entry> entries_;
};

std::vector<Stretch> Covered(const Segment3& segment,
                             const SegmentSet& others,
                             const std::vector<std::size_t>& near,
                             double tolerance) {
  std::vector<Stretch> stretches;
  for (const std::size_t i : near) {
    if (const auto stretch = StretchWithin(segment, others[i], tolerance)) {
      stretches.push_back(*stretch);
    }
  }
  return CoveredAtLeast(stretches, 1);
}

std::optional<double> Share(double part, double whole) {
  if (!(whole > 0)) return std::nullopt;
  return std::min(1.0, part / whole);
}

// Returns the stretches of a true line that a map should have.
std::vector<Stretch> AskedStretches(const TrueLine& line, const LineMapErrorOptions& options) {
  if (options.viewers) return SeenStretches(line, *options.viewers);
  const std::optional<std::int64_t> frames = line.VisibleFrames();
  if (frames && *frames < options.min_visible_frames) return {};
  return {{0, line.segment.Length()}};
}

Segment3 PartOf(const Segment3& segment, const Stretch& stretch) {
  const Eigen::Vector3d d = segment.Direction();
  return {segment.start + stretch.from * d, segment.start + stretch.to * d};
}

void MeasureRecall(std::span<const TrueLine> truth,
                   const SegmentSet& estimate,
                   const LineMapErrorOptions& options,
                   LineMapError& result) {
  std::vector<std::array<double, kTrueLineKinds>> covered(result.at.size());
  std::array<double, kTrueLineKinds> asked = {};
  for (const TrueLine& line : truth) {
    result.true_length += line.segment.Length();
    const std::vector<Stretch> stretches = AskedStretches(line, options);
    result.asked.push_back(!stretches.empty());
    if (stretches.empty()) continue;
    const auto kind = static_cast<std::size_t>(line.kind);
    ++result.asked_lines;
    asked[kind] += TotalLength(stretches);
    for (const Stretch& stretch : stretches) {
      const Segment3 part = PartOf(line.segment, stretch);
      const auto near = estimate.Near(part, options.tolerances.back(), options.max_angle);
      for (std::size_t t = 0; t < result.at.size(); ++t) {
        covered[t][kind] += TotalLength(Covered(part, estimate, near, options.tolerances[t]));
      }
    }
  }
  for (const double length : asked) result.asked_length += length;
  for (std::size_t t = 0; t < result.at.size(); ++t) {
    double sum = 0;
    for (std::size_t kind = 0; kind < kTrueLineKinds; ++kind) {
      sum += covered[t][kind];
      result.at[t].recall_by_kind[kind] = Share(covered[t][kind], asked[kind]);
    }
    result.at[t].recall = Share(sum, result.asked_length);
  }
}

// Returns the root mean square distance of a segment's points from an infinite line.
double DistanceFromLine(const Segment3& segment, const Segment3& line) {
  const Eigen::Vector3d u = line.Direction();
  const auto across = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    const Eigen::Vector3d offset = point - line.start;
    return offset - offset.dot(u) * u;
  };
  const Eigen::Vector3d a = across(segment.start), b = across(segment.end);
  return std::sqrt((a.squaredNorm() + a.dot(b) + b.squaredNorm()) / 3);
}

LineCounterpart FindCounterpart(const Segment3& segment,
                                const SegmentSet& truth,
                                const std::vector<std::size_t>& near,
                                double tolerance) {
  constexpr double kNearlyAsMuch = 0.9;
  std::vector<std::pair<std::size_t, Stretch>> candidates;
  double most = 0;
  for (const std::size_t i : near) {
    const auto stretch = StretchWithin(segment, truth[i], tolerance);
    if (!stretch) continue;
    candidates.emplace_back(i, *stretch);
    most = std::max(most, stretch->Length());
  }
  std::optional<LineCounterpart> best;
  for (const auto& [i, stretch] : candidates) {
    if (stretch.Length() < kNearlyAsMuch * most) continue;
    const double distance = DistanceFromLine(PartOf(segment, stretch), truth[i]);
    if (best && distance >= best->distance) continue;
    const double angle = UndirectedAngle(segment.Direction(), truth[i].Direction());
    best = LineCounterpart{i, 0, angle, distance};
  }
  PLUMBLINE_CHECK(best, "a segment that is covered is covered by a line");
  return *best;
}

// Appends the pieces between the covered stretches.
void AppendGaps(const Segment3& segment,
                const std::vector<Stretch>& covered,
                std::vector<Segment3>& gaps) {
  double from = 0;
  for (const Stretch& stretch : covered) {
    if (stretch.from > from) gaps.push_back(PartOf(segment, {from, stretch.from}));
    from = stretch.to;
  }
  const double length = segment.Length();
  if (length > from) gaps.push_back(PartOf(segment, {from, length}));
}

// Measures the precision and finds the counterparts. Returns the uncovered parts at the largest
// tolerance.
std::vector<Segment3> MeasurePrecision(const SegmentSet& truth,
                                       const SegmentSet& estimate,
                                       const LineMapErrorOptions& options,
                                       LineMapError& result) {
  std::vector<double> covered_length(result.at.size());
  std::vector<Segment3> gaps;
  result.counterparts.resize(estimate.size());
  for (std::size_t e = 0; e < estimate.size(); ++e) {
    const Segment3& segment = estimate[e];
    const double length = segment.Length();
    if (length == 0) continue;
    result.estimated_length += length;
    const auto near = truth.Near(segment, options.tolerances.back(), options.max_angle);
    std::vector<Stretch> covered;
    for (std::size_t t = 0; t < result.at.size(); ++t) {
      covered = Covered(segment, truth, near, options.tolerances[t]);
      const double sum = TotalLength(covered);
      covered_length[t] += sum;
      if (!result.counterparts[e] && sum >= 0.5 * length) {
        result.counterparts[e] = FindCounterpart(segment, truth, near, options.tolerances[t]);
        result.counterparts[e]->tolerance = t;
      }
    }
    AppendGaps(segment, covered, gaps);
  }
  for (std::size_t t = 0; t < result.at.size(); ++t) {
    result.at[t].precision = Share(covered_length[t], result.estimated_length);
  }
  return gaps;
}

// Returns the part of a line that the orthogonal projection of a segment covers.
Stretch Projection(const Segment3& segment, const Segment3& line) {
  const Eigen::Vector3d u = line.Direction();
  const double length = line.Length();
  const double a = std::clamp(u.dot(segment.start - line.start), 0.0, length);
  const double b = std::clamp(u.dot(segment.end - line.start), 0.0, length);
  return {std::min(a, b), std::max(a, b)};
}

void MeasureCounterparts(const SegmentSet& truth,
                         const SegmentSet& estimate,
                         std::size_t tolerance,
                         LineMapError& result) {
  std::vector<double> angles, distances;
  std::vector<std::vector<Stretch>> mapped(truth.size());
  for (std::size_t e = 0; e < estimate.size(); ++e) {
    const std::optional<LineCounterpart>& counterpart = result.counterparts[e];
    if (!counterpart || counterpart->tolerance > tolerance) continue;
    angles.push_back(counterpart->angle);
    distances.push_back(counterpart->distance);
    mapped[counterpart->true_line].push_back(
        Projection(estimate[e], truth[counterpart->true_line]));
  }
  if (angles.empty()) return;
  LineMapErrorAt& at = result.at[tolerance];
  at.with_counterpart = angles.size();
  at.median_angle = StatisticsOf(std::move(angles))->median;
  at.median_distance = StatisticsOf(std::move(distances))->median;
  std::size_t lines = 0;
  double all = 0, once = 0;
  for (const std::vector<Stretch>& stretches : mapped) {
    if (stretches.empty()) continue;
    ++lines;
    all += TotalLength(stretches);
    once += TotalLength(CoveredAtLeast(stretches, 1));
  }
  at.segments_per_line = static_cast<double>(at.with_counterpart) / static_cast<double>(lines);
  if (once > 0) at.multiplicity = all / once;
}

}  // namespace

LineMapError CompareLineMaps(std::span<const TrueLine> truth,
                             std::span<const Segment3> estimate,
                             std::span<const Parallelogram> surfaces,
                             const LineMapErrorOptions& options) {
  PLUMBLINE_CHECK(!options.tolerances.empty() && options.tolerances.front() > 0 &&
                      std::is_sorted(options.tolerances.begin(), options.tolerances.end()),
                  "tolerances ascend from above zero");
  SegmentSet true_set, estimated_set;
  for (const TrueLine& line : truth) true_set.Add(line.segment);
  for (const Segment3& segment : estimate) estimated_set.Add(segment);
  LineMapError result;
  result.true_lines = truth.size();
  result.estimated_segments = estimate.size();
  result.at.resize(options.tolerances.size());
  MeasureRecall(truth, estimated_set, options, result);
  const std::vector<Segment3> gaps = MeasurePrecision(true_set, estimated_set, options, result);
  for (std::size_t t = 0; t < result.at.size(); ++t) {
    result.at[t].tolerance = options.tolerances[t];
    MeasureCounterparts(true_set, estimated_set, t, result);
  }
  for (const Segment3& gap : gaps) result.uncovered_length += gap.Length();
  result.uncovered_from_surfaces = DistanceFromSurfaces(gaps, surfaces, options.surface_limit);
  return result;
}

}  // namespace plumbline
