// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_ends.h"

#include "plumbline/geometry/trimming.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace plumbline {
namespace {

constexpr LineInterval kAroundFoot{-1, 1};
// Ends nearer to each other than this part of their distance from the origin make no line.
constexpr double kMinRelativeLength = 1e-6;

bool MakeALine(const Segment3& ends) {
  const bool is_long = ends.Length() > kMinRelativeLength * (ends.start.norm() + ends.end.norm());
  return is_long && ends.start.allFinite() && ends.end.allFinite();
}

std::optional<Segment3> Trim(const BaProblem& problem, const BaProblem::LineObservation& o) {
  const PluckerLine line = ToPlucker(problem.lines[static_cast<std::size_t>(o.line)]);
  Rigid3 cam_from_world = problem.poses[static_cast<std::size_t>(o.pose)].cam_from_world;
  cam_from_world.translation.x() += problem.camera.ShiftInto(o.measurement.camera);
  auto interval = TrimToSegment(problem.camera, cam_from_world, line, o.measurement.segment);
  if (!interval) return std::nullopt;
  if (interval->end < interval->start) std::swap(interval->start, interval->end);
  const Segment3 ends = SegmentOf(line, *interval);
  return MakeALine(ends) ? std::optional(ends) : std::nullopt;
}

}  // namespace

std::vector<Segment3> TrimmedEnds(const BaProblem& problem) {
  const auto& observations = problem.line_observations;
  std::vector<std::size_t> by_pose(observations.size());
  std::iota(by_pose.begin(), by_pose.end(), std::size_t{0});
  std::stable_sort(by_pose.begin(), by_pose.end(), [&](std::size_t a, std::size_t b) {
    return observations[a].pose < observations[b].pose;
  });
  std::vector<std::optional<Segment3>> trimmed(problem.lines.size());
  for (const std::size_t k : by_pose) {
    auto& ends = trimmed[static_cast<std::size_t>(observations[k].line)];
    if (!ends) ends = Trim(problem, observations[k]);
  }
  std::vector<Segment3> out;
  out.reserve(trimmed.size());
  for (std::size_t i = 0; i < trimmed.size(); ++i) {
    out.push_back(trimmed[i] ? *trimmed[i] : SegmentOf(ToPlucker(problem.lines[i]), kAroundFoot));
  }
  return out;
}

std::vector<Segment3> EndsOf(const BaProblem& problem) {
  return problem.line_ends.empty() ? TrimmedEnds(problem) : problem.line_ends;
}

std::vector<Segment3> EndsOfLines(const std::vector<Segment3>& before,
                                  const std::vector<Segment3>& moved) {
  std::vector<Segment3> ends(before);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (MakeALine(moved[i])) ends[i] = moved[i];
  }
  return ends;
}

std::vector<OrthonormalLine> LinesThroughEnds(const std::vector<OrthonormalLine>& lines,
                                              const std::vector<Segment3>& before,
                                              const std::vector<Segment3>& ends) {
  std::vector<OrthonormalLine> out(lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (ends[i].start == before[i].start && ends[i].end == before[i].end) continue;
    out[i] = ToOrthonormal(LineThroughPoints(ends[i].start, ends[i].end));
  }
  return out;
}

}  // namespace plumbline
