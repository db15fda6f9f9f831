// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_problem.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/matching/measurements.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Returns the factor by which depths have changed, as the median over points; nullopt if there are
// too few of them.
std::optional<double> ScaleAround(const std::vector<std::pair<double, double>>& depths) {
  constexpr std::size_t kFew = 10;
  std::vector<double> ratios;
  for (const auto& [before, after] : depths) {
    if (before > 0 && after > 0) ratios.push_back(after / before);
  }
  if (ratios.size() < kFew) return std::nullopt;
  return UpperMedian(ratios);
}

// Scales all lengths of a solution about the fixed point `centre`.
void ScaleAbout(const Eigen::Vector3d& centre, double scale, BaResult& result) {
  for (Rigid3& pose : result.poses) {
    pose.translation = scale * pose.translation + (scale - 1) * (pose.rotation * centre);
  }
  for (Eigen::Vector3d& point : result.points) point = scale * point + (1 - scale) * centre;
  for (OrthonormalLine& line : result.lines) {
    PluckerLine scaled = ToPlucker(line);
    scaled.moment = scale * scaled.moment + (1 - scale) * centre.cross(scaled.direction);
    line = ToOrthonormal(scaled);
  }
  for (Segment3& ends : result.line_ends) {
    ends.start = scale * ends.start + (1 - scale) * centre;
    ends.end = scale * ends.end + (1 - scale) * centre;
  }
}

void Move(const Rigid3& new_from_old, BaResult& result) {
  const Rigid3 old_from_new = Inverse(new_from_old);
  for (Rigid3& pose : result.poses) pose = pose * old_from_new;
  for (Eigen::Vector3d& point : result.points) point = new_from_old * point;
  for (OrthonormalLine& line : result.lines) {
    line = ToOrthonormal(Transform(new_from_old, ToPlucker(line)));
  }
  for (Segment3& ends : result.line_ends) {
    ends = {new_from_old * ends.start, new_from_old * ends.end};
  }
}

constexpr std::size_t kViewsForTrimming = 4;

}  // namespace

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

std::vector<double> ScalesOf(const BaProblem& problem, const BaResult& result) {
  std::vector<double> scales(problem.poses.size(), 1);
  if (KnowsUnitOfLength(problem.camera)) return scales;
  std::vector<std::vector<std::pair<double, double>>> depths(problem.poses.size());
  for (const auto& o : problem.point_observations) {
    const auto pose = static_cast<std::size_t>(o.pose);
    const auto point = static_cast<std::size_t>(o.point);
    depths[pose].emplace_back((problem.poses[pose].cam_from_world * problem.points[point]).z(),
                              (result.poses[pose] * result.points[point]).z());
  }
  std::optional<double> last;
  for (std::size_t k = 0; k < scales.size() && !last; ++k) last = ScaleAround(depths[k]);
  for (std::size_t k = 0; k < scales.size() && last; ++k) {
    scales[k] = ScaleAround(depths[k]).value_or(*last);
    last = scales[k];
  }
  return scales;
}

void FixScaleToOldestKeyFrame(const BaProblem& problem, BaResult& result) {
  if (problem.poses.empty() || KnowsUnitOfLength(problem.camera)) return;
  const auto fixed = std::count_if(
      problem.poses.begin(), problem.poses.end(), [](const auto& pose) { return pose.fixed; });
  if (fixed > 1) return;
  const Eigen::Vector3d centre = Inverse(problem.poses.front().cam_from_world).translation;
  ScaleAbout(centre, 1 / ScalesOf(problem, result).front(), result);
}

void KeepPlaceOf(std::size_t pose, const BaProblem& problem, BaResult& result) {
  if (KnowsUnitOfLength(problem.camera)) return;
  const double scale = 1 / ScalesOf(problem, result)[pose];
  Move(Inverse(problem.poses[pose].cam_from_world) * result.poses[pose], result);
  ScaleAbout(Inverse(result.poses[pose]).translation, scale, result);
}

edit::MoveLine RefitInterval(const Map& map,
                             const CameraAndPyramid& imaging,
                             const std::map<KeyFrameId, Rigid3>& poses,
                             const MapLine& line,
                             const PluckerLine& moved,
                             const std::optional<Segment3>& kept) {
  PluckerLine target = moved;
  if (target.direction.dot(line.line.direction) < 0) target = {-moved.moment, -moved.direction};
  edit::MoveLine change{line.id, target, 0, 0, Eigen::Matrix4d::Zero()};
  const PreparedLine prepared(ToOrthonormal(target));
  std::vector<double> starts;
  std::vector<double> ends;
  for (const auto& [id, feature] : line.observations) {
    const Frame& in_map = map.Find(id)->frame;
    const auto it = poses.find(id);
    Frame frame;  // has the features, which are shared, and the new pose; matches are not needed
    frame.indexed = in_map.indexed;
    frame.cam_from_world = it != poses.end() ? it->second : in_map.cam_from_world;
    const auto i = static_cast<std::size_t>(feature);
    change.information += LineInformation(imaging.camera, frame, i, prepared);
    if (kept) continue;
    const auto interval = TrimToSegment(
        imaging.camera, frame.cam_from_world, target, frame.features().lines[i].segment);
    if (!interval) continue;
    starts.push_back(std::min(interval->start, interval->end));
    ends.push_back(std::max(interval->start, interval->end));
  }
  if (starts.empty()) {
    const Segment3 points = kept.value_or(line.Interval());
    change.start = target.ParameterOf(points.start);
    change.end = target.ParameterOf(points.end);
    if (kept && change.end < change.start) std::swap(change.start, change.end);
    return change;
  }
  std::sort(starts.begin(), starts.end());
  std::sort(ends.begin(), ends.end());
  const std::size_t skip = starts.size() >= kViewsForTrimming ? 1 : 0;
  change.start = starts[skip];
  change.end = ends[ends.size() - 1 - skip];
  if (change.end <= change.start) {
    change.start = starts.front();
    change.end = ends.back();
  }
  return change;
}

}  // namespace plumbline
