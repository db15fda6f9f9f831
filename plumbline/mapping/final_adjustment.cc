// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/final_adjustment.h"

#include "plumbline/mapping/line_map.h"
#include "plumbline/optimization/local_ba.h"

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// The whole map as a plain problem in the frame of its first keyframe, and what its numbers stand
// for.
struct WholeMap {
  BaProblem problem;
  Rigid3 problem_from_world;
  std::vector<KeyFrameId> keyframes;  // by pose index
  std::vector<PointId> points;
};

class WholeMapBuilder {
 public:
  WholeMapBuilder(const Map& map, const ImagingModel& imaging, const LineOptions& lines)
      : map_(map), weighting_(lines.weighting) {
    whole_.problem.camera = imaging.camera;
    whole_.problem_from_world = map.keyframes().begin()->second.frame.cam_from_world;
  }

  WholeMap Build(const std::vector<WellSeenLine>& lines) {
    AddPoses();
    AddPoints();
    for (const WellSeenLine& line : lines) AddLine(line);
    return std::move(whole_);
  }

 private:
  void AddPoses() {
    const Rigid3 world_from_problem = Inverse(whole_.problem_from_world);
    for (const auto& [id, keyframe] : map_.keyframes()) {
      const bool first = whole_.keyframes.empty();
      pose_of_[id] = static_cast<int>(whole_.keyframes.size());
      whole_.keyframes.push_back(id);
      whole_.problem.poses.push_back({keyframe.frame.cam_from_world * world_from_problem, first});
    }
  }

  void AddPoints() {
    for (const auto& [id, point] : map_.points()) {
      if (point.observations.size() < 2) continue;
      const int index = static_cast<int>(whole_.points.size());
      whole_.points.push_back(id);
      whole_.problem.points.push_back(whole_.problem_from_world * point.position);
      for (const auto& [keyframe, feature] : point.observations) {
        const Features& features = map_.Find(keyframe)->frame.features();
        whole_.problem.point_observations.push_back(
            {pose_of_.at(keyframe),
             index,
             MeasurePoint(features, static_cast<std::size_t>(feature))});
      }
    }
  }

  void AddLine(const WellSeenLine& line) {
    const int index = static_cast<int>(whole_.problem.lines.size());
    whole_.problem.lines.push_back(ToOrthonormal(Transform(whole_.problem_from_world, line.line)));
    auto& observations = whole_.problem.line_observations;
    for (const LineSupport& support : line.supports) {
      const int pose = pose_of_.at(support.keyframe->id);
      const Features& features = support.keyframe->frame.features();
      observations.push_back({pose, index, MeasureLeftLine(features, support.feature, weighting_)});
      if (!support.right) continue;
      observations.push_back(
          {pose, index, *MeasureRightLine(features, support.feature, weighting_)});
    }
  }

  const Map& map_;
  LineWeighting weighting_;
  WholeMap whole_;
  std::map<KeyFrameId, int> pose_of_;
};

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

MapEdit ToEdit(const Map& map, const WholeMap& whole, const BaResult& result) {
  MapEdit edit;
  std::map<KeyFrameId, Rigid3> poses;
  for (std::size_t k = 0; k < whole.keyframes.size(); ++k) {
    poses[whole.keyframes[k]] = result.poses[k] * whole.problem_from_world;
    edit.push_back(edit::SetPose{whole.keyframes[k], poses[whole.keyframes[k]]});
  }
  const Rigid3 world_from_problem = Inverse(whole.problem_from_world);
  for (std::size_t k = 0; k < whole.points.size(); ++k) {
    edit.push_back(edit::MovePoint{whole.points[k], world_from_problem * result.points[k]});
  }
  const auto& observations = whole.problem.point_observations;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (result.point_inliers[k]) continue;
    edit.push_back(edit::RemovePointObservation{
        whole.points[static_cast<std::size_t>(observations[k].point)],
        whole.keyframes[static_cast<std::size_t>(observations[k].pose)]});
  }
  MoveLines(map, poses, edit);
  return edit;
}

}  // namespace

MapEdit AdjustWholeMap(const Map& map,
                       const ImagingModel& imaging,
                       const LineOptions& lines,
                       const MappingOptions& options) {
  constexpr std::size_t kMinKeyFrames = 3;
  const std::size_t count = map.keyframes().size();
  if (count < kMinKeyFrames ||
      count > static_cast<std::size_t>(options.final_adjustment_keyframes)) {
    return {};
  }
  const WholeMap whole =
      WholeMapBuilder(map, imaging, lines).Build(FindWellSeenLines(map, imaging, options.line_map));
  BaResult result = SolveLocalBa(whole.problem, options.ba, LineParametrization::kPlucker);
  if (result.termination == BaTermination::kNotFinite) return {};
  KeepScale(whole.problem, result);
  return ToEdit(map, whole, result);
}

}  // namespace plumbline
