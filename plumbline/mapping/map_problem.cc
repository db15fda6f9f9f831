// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_problem.h"

namespace plumbline {

MapProblemBuilder::MapProblemBuilder(const Map& map,
                                     const CameraAndPyramid& imaging,
                                     const LineWeights& weights,
                                     KeyFrameId origin,
                                     MapProblem& out)
    : map_(map),
      weights_(weights),
      out_(out),
      pose_of_(static_cast<std::size_t>(map.NextKeyFrameId().value), kNoPose) {
  out_.problem.camera = imaging.camera;
  out_.problem_from_world = map.Find(origin)->frame.cam_from_world;
  world_from_problem_ = Inverse(out_.problem_from_world);
}

void MapProblemBuilder::AddPose(KeyFrameId id, bool fixed) {
  const Frame& frame = map_.Find(id)->frame;
  pose_of_[static_cast<std::size_t>(id.value)] = static_cast<int>(frames_.size());
  frames_.push_back(&frame);
  const bool follows = !out_.keyframes.empty() && Follows(out_.keyframes.back(), id);
  out_.keyframes.push_back(id);
  out_.problem.poses.push_back({frame.cam_from_world * world_from_problem_, fixed, follows});
}

// Returns true if keyframe `id` comes soon after `before`. Keyframes between them may be missing
// from the problem, because they share no landmark with it.
bool MapProblemBuilder::Follows(KeyFrameId before, KeyFrameId id) const {
  constexpr int kBetween = 4;
  auto place = map_.keyframes().find(id);
  for (int k = 0; k <= kBetween && place != map_.keyframes().begin(); ++k) {
    if ((--place)->first == before) return true;
  }
  return false;
}

const std::vector<MapProblemBuilder::View>& MapProblemBuilder::ViewsOf(
    const Observations& observations) {
  views_.clear();
  for (const auto& [keyframe, feature] : observations) {
    const int pose = PoseOf(keyframe);
    if (pose != kNoPose) views_.push_back({pose, static_cast<std::size_t>(feature)});
  }
  return views_;
}

void MapProblemBuilder::AddPoint(const MapPoint& point) {
  const std::vector<View>& views = ViewsOf(point.observations);
  if (views.size() < 2) return;
  const int index = static_cast<int>(out_.points.size());
  out_.points.push_back(point.id);
  out_.problem.points.push_back(out_.problem_from_world * point.position);
  for (const View& view : views) {
    out_.problem.point_observations.push_back(
        {view.pose, index, MeasurePoint(FeaturesOf(view), view.feature)});
  }
}

int MapProblemBuilder::AddLine(const PluckerLine& in_world) {
  out_.problem.lines.push_back(ToOrthonormal(Transform(out_.problem_from_world, in_world)));
  return static_cast<int>(out_.problem.lines.size()) - 1;
}

void MapProblemBuilder::AddEnds(const Segment3& in_world) {
  const Rigid3& in_problem = out_.problem_from_world;
  out_.problem.line_ends.push_back({in_problem * in_world.start, in_problem * in_world.end});
}

void MapProblemBuilder::AddLineView(int line, const View& view, bool with_right) {
  const Features& features = FeaturesOf(view);
  auto& observations = out_.problem.line_observations;
  observations.push_back({view.pose, line, MeasureLeftLine(features, view.feature, weights_)});
  if (!with_right) return;
  if (const auto right = MeasureRightLine(features, view.feature, weights_)) {
    observations.push_back({view.pose, line, *right});
  }
}

std::vector<edit::RemovePointObservation> OutliersOf(const MapProblem& part,
                                                     const BaResult& result) {
  std::vector<edit::RemovePointObservation> outliers;
  const auto& observations = part.problem.point_observations;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (result.point_inliers[k]) continue;
    outliers.push_back({part.points[static_cast<std::size_t>(observations[k].point)],
                        part.keyframes[static_cast<std::size_t>(observations[k].pose)]});
  }
  return outliers;
}

MapEdit PosesAndPointsOf(const MapProblem& part, const BaResult& result) {
  MapEdit edit;
  for (std::size_t k = 0; k < part.keyframes.size(); ++k) {
    if (part.problem.poses[k].fixed) continue;
    edit.push_back(edit::SetPose{part.keyframes[k], result.poses[k] * part.problem_from_world});
  }
  const Rigid3 world_from_problem = Inverse(part.problem_from_world);
  for (std::size_t k = 0; k < part.points.size(); ++k) {
    edit.push_back(edit::MovePoint{part.points[k], world_from_problem * result.points[k]});
  }
  const auto outliers = OutliersOf(part, result);
  edit.insert(edit.end(), outliers.begin(), outliers.end());
  return edit;
}

std::map<KeyFrameId, Rigid3> PosesByKeyFrame(const MapProblem& part, const BaResult& result) {
  std::map<KeyFrameId, Rigid3> poses;
  for (std::size_t k = 0; k < part.keyframes.size(); ++k) {
    poses[part.keyframes[k]] = result.poses[k] * part.problem_from_world;
  }
  return poses;
}

}  // namespace plumbline
