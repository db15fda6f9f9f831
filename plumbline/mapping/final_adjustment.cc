// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/final_adjustment.h"

#include "plumbline/mapping/line_map.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/optimization/envelope_cholesky.h"
#include "plumbline/optimization/pose_sigma.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

// An adjustment gains from lines that are not good enough to be given out: what does not fit weighs
// little there.
constexpr LineMapOptions kAdjustedLines{.min_keyframes = 4,
                                        .max_relative_sigma = 0.02,
                                        .min_found_ratio = 0.25,
                                        .max_mean_chi2 = std::numeric_limits<double>::infinity(),
                                        .min_mean_length_px = 0};

// The whole map, with the lines that are well seen, as a problem in the frame of its first
// keyframe.
MapProblem MakeWholeMap(const Map& map,
                        const ImagingModel& imaging,
                        LineWeighting weighting,
                        const std::vector<WellSeenLine>& lines) {
  MapProblem whole;
  const KeyFrameId first = map.keyframes().begin()->first;
  MapProblemBuilder builder(map, imaging, weighting, first, whole);
  for (const auto& [id, keyframe] : map.keyframes()) builder.AddPose(id, id == first);
  for (const auto& [id, point] : map.points()) builder.AddPoint(point);
  for (const WellSeenLine& line : lines) {
    const int index = builder.AddLine(line.line);
    for (const LineSupport& support : line.supports) {
      const int pose = builder.PoseOf(support.keyframe->id);
      builder.AddLineView(index, {pose, support.feature}, support.right);
    }
  }
  return whole;
}

// By pose the first that it shares a landmark with.
std::vector<int> FirstSharing(const BaProblem& problem) {
  const auto lower = [](std::vector<int>& first, int index, int pose) {
    int& value = first[static_cast<std::size_t>(index)];
    value = std::min(value, pose);
  };
  const int last = static_cast<int>(problem.poses.size());
  std::vector<int> of_point(problem.points.size(), last), of_line(problem.lines.size(), last);
  for (const auto& o : problem.point_observations) lower(of_point, o.point, o.pose);
  for (const auto& o : problem.line_observations) lower(of_line, o.line, o.pose);
  std::vector<int> of_pose(problem.poses.size());
  std::iota(of_pose.begin(), of_pose.end(), 0);
  for (const auto& o : problem.point_observations) {
    lower(of_pose, o.pose, of_point[static_cast<std::size_t>(o.point)]);
  }
  for (const auto& o : problem.line_observations) {
    lower(of_pose, o.pose, of_line[static_cast<std::size_t>(o.line)]);
  }
  return of_pose;
}

// Only a map of more keyframes than the limit can.
bool TakesTooLong(const MapProblem& whole, int limit) {
  return EnvelopeSize(FirstSharing(whole.problem)) > limit;
}

// Line landmarks keep their place before the newest keyframe that shows them.
void MoveLines(const Map& map, const std::map<KeyFrameId, Rigid3>& poses, MapEdit& edit) {
  for (const auto& [id, line] : map.lines()) {
    const KeyFrameId newest = line.observations.newest().first;
    const Rigid3 motion = Inverse(poses.at(newest)) * map.Find(newest)->frame.cam_from_world;
    edit::MoveLine change{id, Transform(motion, line.line), 0, 0, line.information};
    change.start = change.line.ParameterOf(motion * line.line.PointAt(line.start));
    change.end = change.line.ParameterOf(motion * line.line.PointAt(line.end));
    edit.push_back(change);
  }
}

// Of the distances between keyframes that follow each other.
double PathLength(const std::vector<Rigid3>& poses) {
  double length = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    length += (Inverse(poses[k]).translation - Inverse(poses[k - 1]).translation).norm();
  }
  return length;
}

// A single camera leaves the scale of the whole open; the frames between the keyframes keep the one
// that they were tracked with, and so must these.
void KeepScale(const BaProblem& problem, BaResult& result) {
  if (problem.camera.baseline > 0) return;
  std::vector<Rigid3> before;
  for (const auto& pose : problem.poses) before.push_back(pose.cam_from_world);
  const double length = PathLength(result.poses);
  if (!(length > 0)) return;
  const double scale = PathLength(before) / length;
  for (Rigid3& pose : result.poses) pose.translation *= scale;
  for (Eigen::Vector3d& point : result.points) point *= scale;
}

}  // namespace

MapEdit AdjustWholeMap(const Map& map,
                       const ImagingModel& imaging,
                       const LineOptions& lines,
                       const MappingOptions& options) {
  constexpr std::size_t kMinKeyFrames = 3;
  const int limit = options.final_adjustment_keyframes;
  const std::size_t count = map.keyframes().size();
  if (count < kMinKeyFrames || limit == 0) return {};
  const bool large = count > static_cast<std::size_t>(limit);
  // The points alone tell of many maps, before the search for lines.
  if (large && TakesTooLong(MakeWholeMap(map, imaging, lines.weighting, {}), limit)) return {};
  const MapProblem whole =
      MakeWholeMap(map, imaging, lines.weighting, FindWellSeenLines(map, imaging, kAdjustedLines));
  if (large && TakesTooLong(whole, limit)) return {};
  BaProblem problem = whole.problem;
  // Poses that are held are free in `whole`: a new scale is for all.
  const std::optional<BaResult> result =
      SolveInOnePiece(problem,
                      options.ba,
                      lines.parametrization,
                      options.window.final_limits(),
                      [&](BaResult& solution) { KeepScale(whole.problem, solution); });
  if (!result) return {};
  MapEdit edit = PosesAndPointsOf(whole, *result);
  MoveLines(map, PosesByKeyFrame(whole, *result), edit);
  return edit;
}

}  // namespace plumbline
