// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/ba_window.h"

#include "plumbline/association/line_information.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/line_interval.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace plumbline {
namespace {

// Builds a BaWindow step by step: keyframes, then landmarks, then observations.
class WindowBuilder {
 public:
  WindowBuilder(const Map& map,
                const ImagingModel& imaging,
                LineWeighting weighting,
                const BaWindowOptions& options)
      : map_(map), weighting_(weighting), options_(options) {
    window_.problem.camera = imaging.camera;
  }

  BaWindow Build(KeyFrameId centre) {
    window_.window_from_world = map_.Find(centre)->frame.cam_from_world;
    world_from_window_ = Inverse(window_.window_from_world);
    ChooseFree(centre);
    ChooseLandmarks();
    ChooseFixed();
    AddPoints();
    AddLines();
    return std::move(window_);
  }

 private:
  void AddPose(KeyFrameId id, bool fixed) {
    pose_index_[id] = static_cast<int>(window_.keyframes.size());
    window_.keyframes.push_back(id);
    const Rigid3& cam_from_world = map_.Find(id)->frame.cam_from_world;
    window_.problem.poses.push_back({cam_from_world * world_from_window_, fixed});
  }

  void ChooseFree(KeyFrameId centre) {
    const KeyFrameId origin = map_.keyframes().begin()->first;
    std::vector<KeyFrameId> free{centre};
    for (const auto& neighbour : Covisible(map_, centre, options_.min_shared)) {
      if (static_cast<int>(free.size()) >= options_.free_keyframes) break;
      free.push_back(neighbour.id);
    }
    std::sort(free.begin(), free.end());
    for (const KeyFrameId id : free) AddPose(id, id == origin);
  }

  void ChooseLandmarks() {
    for (const KeyFrameId id : window_.keyframes) {
      const Frame& frame = map_.Find(id)->frame;
      for (const PointId point : frame.points) {
        if (point.valid() && map_.Find(point)->observations.size() >= 2) points_.insert(point);
      }
      for (const LineId line : frame.lines) {
        if (line.valid() && map_.Find(line)->observations.size() >= 2) lines_.insert(line);
      }
    }
  }

  void ChooseFixed() {
    std::map<KeyFrameId, int> shared;
    const auto count = [&](const Observations& observations) {
      for (const auto& [id, feature] : observations) {
        if (!pose_index_.contains(id)) ++shared[id];
      }
    };
    for (const PointId id : points_) count(map_.Find(id)->observations);
    for (const LineId id : lines_) count(map_.Find(id)->observations);
    std::vector<CovisibleKeyFrame> others = RankByShared(shared, 1);
    if (static_cast<int>(others.size()) > options_.fixed_keyframes) {
      others.resize(static_cast<std::size_t>(options_.fixed_keyframes));
    }
    for (const auto& other : others) AddPose(other.id, true);
    const auto& poses = window_.problem.poses;
    if (std::none_of(poses.begin(), poses.end(), [](const auto& p) { return p.fixed; })) {
      window_.problem.poses.front().fixed = true;  // the oldest: something must hold the gauge
    }
  }

  int ViewsInWindow(const Observations& observations) const {
    return static_cast<int>(
        std::count_if(observations.begin(), observations.end(), [&](const auto& observation) {
          return pose_index_.contains(observation.first);
        }));
  }

  void AddPoints() {
    for (const PointId id : points_) {
      const MapPoint& point = *map_.Find(id);
      if (ViewsInWindow(point.observations) < 2) continue;
      const int index = static_cast<int>(window_.points.size());
      window_.points.push_back(id);
      window_.problem.points.push_back(window_.window_from_world * point.position);
      for (const auto& [keyframe, feature] : point.observations) {
        const auto pose = pose_index_.find(keyframe);
        if (pose == pose_index_.end()) continue;
        window_.problem.point_observations.push_back(
            {pose->second,
             index,
             MeasurePoint(map_.Find(keyframe)->frame.features(),
                          static_cast<std::size_t>(feature))});
      }
    }
  }

  void AddLines() {
    for (const LineId id : lines_) {
      const MapLine& line = *map_.Find(id);
      if (ViewsInWindow(line.observations) < 2) continue;
      if (!WellConditioned(line)) {
        window_.young_lines.push_back(id);
        continue;
      }
      const int index = static_cast<int>(window_.lines.size());
      window_.lines.push_back(id);
      window_.problem.lines.push_back(
          ToOrthonormal(Transform(window_.window_from_world, line.line)));
      for (const auto& [keyframe, feature] : line.observations) {
        const auto pose = pose_index_.find(keyframe);
        if (pose == pose_index_.end()) continue;
        AddLineObservations(pose->second, index, map_.Find(keyframe)->frame.features(), feature);
      }
    }
  }

  void AddLineObservations(int pose, int line, const Features& features, int feature) {
    const auto i = static_cast<std::size_t>(feature);
    auto& observations = window_.problem.line_observations;
    observations.push_back({pose, line, MeasureLeftLine(features, i, weighting_)});
    if (const auto right = MeasureRightLine(features, i, weighting_)) {
      observations.push_back({pose, line, *right});
    }
  }

  // Wide angle between the interpretation planes of the first view and another (left images), or
  // ends that the information fixes.
  bool WellConditioned(const MapLine& line) const {
    const double limit = std::cos(options_.min_line_plane_angle_deg * std::numbers::pi / 180);
    std::optional<Eigen::Vector3d> first;
    for (const auto& [keyframe, feature] : line.observations) {
      const Rigid3 world_from_cam = Inverse(map_.Find(keyframe)->frame.cam_from_world);
      const Eigen::Vector3d normal =
          (line.line.moment - world_from_cam.translation.cross(line.line.direction)).normalized();
      if (!first) first = normal;
      if (std::abs(first->dot(normal)) <= limit) return true;
    }
    const KeyFrame& newest = *map_.Find(line.observations.rbegin()->first);
    const auto known = [&](double t) {
      const double distance = (newest.frame.cam_from_world * line.line.PointAt(t)).norm();
      return SigmaAt(line.line, line.information, t) <= options_.max_line_relative_sigma * distance;
    };
    return known(line.start) && known(line.end);
  }

  const Map& map_;
  LineWeighting weighting_;
  const BaWindowOptions& options_;
  BaWindow window_;
  Rigid3 world_from_window_;
  std::map<KeyFrameId, int> pose_index_;
  std::set<PointId> points_;
  std::set<LineId> lines_;
};

}  // namespace

BaWindow MakeBaWindow(const Map& map,
                      const ImagingModel& imaging,
                      KeyFrameId centre,
                      LineWeighting weighting,
                      const BaWindowOptions& options) {
  return WindowBuilder(map, imaging, weighting, options).Build(centre);
}

namespace {

void RemoveOutliers(const BaWindow& window, const BaResult& result, MapEdit& edit) {
  const auto& points = window.problem.point_observations;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (result.point_inliers[k]) continue;
    edit.push_back(
        edit::RemovePointObservation{window.points[static_cast<std::size_t>(points[k].point)],
                                     window.keyframes[static_cast<std::size_t>(points[k].pose)]});
  }
  const auto& lines = window.problem.line_observations;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (result.line_inliers[k]) continue;
    edit.push_back(
        edit::RemoveLineObservation{window.lines[static_cast<std::size_t>(lines[k].line)],
                                    window.keyframes[static_cast<std::size_t>(lines[k].pose)]});
  }
}

// The window's lines with the observations that stay.
std::vector<MapLine> LinesWithoutOutliers(const Map& map,
                                          const BaWindow& window,
                                          const BaResult& result) {
  std::vector<MapLine> lines;
  for (const LineId id : window.lines) lines.push_back(*map.Find(id));
  const auto& observations = window.problem.line_observations;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (result.line_inliers[k]) continue;
    lines[static_cast<std::size_t>(observations[k].line)].observations.erase(
        window.keyframes[static_cast<std::size_t>(observations[k].pose)]);
  }
  return lines;
}

}  // namespace

MapEdit ToEdit(const Map& map,
               const ImagingModel& imaging,
               const BaWindow& window,
               const BaResult& result) {
  MapEdit edit;
  for (std::size_t k = 0; k < window.keyframes.size(); ++k) {
    if (window.problem.poses[k].fixed) continue;
    edit.push_back(edit::SetPose{window.keyframes[k], result.poses[k] * window.window_from_world});
  }
  const Rigid3 world_from_window = Inverse(window.window_from_world);
  for (std::size_t k = 0; k < window.points.size(); ++k) {
    edit.push_back(edit::MovePoint{window.points[k], world_from_window * result.points[k]});
  }
  // Intervals and information follow from the poses and observations as they will be.
  std::map<KeyFrameId, Rigid3> poses;
  for (std::size_t k = 0; k < window.keyframes.size(); ++k) {
    poses[window.keyframes[k]] = result.poses[k] * window.window_from_world;
  }
  const std::vector<MapLine> lines = LinesWithoutOutliers(map, window, result);
  for (std::size_t k = 0; k < window.lines.size(); ++k) {
    const PluckerLine line = Transform(world_from_window, ToPlucker(result.lines[k]));
    edit.push_back(RefitInterval(map, imaging, poses, lines[k], line));
  }
  RemoveOutliers(window, result, edit);
  return edit;
}

}  // namespace plumbline
