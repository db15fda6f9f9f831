// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/local_landmarks.h"

#include "plumbline/base/error.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/map/motion.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

template <class LandmarkId>
void AddValid(const std::vector<LandmarkId>& matches, std::vector<LandmarkId>& ids) {
  for (const LandmarkId id : matches) {
    if (id.valid()) ids.push_back(id);
  }
}

template <class Landmark, class LandmarkId>
std::vector<const Landmark*> Resolve(const Map& map, std::vector<LandmarkId>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<const Landmark*> landmarks;
  landmarks.reserve(ids.size());
  for (const LandmarkId id : ids) {
    if (const Landmark* landmark = map.Find(id)) landmarks.push_back(landmark);
  }
  return landmarks;
}

}  // namespace

LocalLandmarks LandmarksAround(const Map& map, KeyFrameId id, int neighbours) {
  LocalLandmarks local;
  local.keyframe = map.Find(id);
  PLUMBLINE_CHECK(local.keyframe != nullptr, "landmarks around a keyframe that is not in the map");
  std::vector<PointId> points;
  std::vector<LineId> lines;
  AddValid(local.keyframe->frame.points, points);
  AddValid(local.keyframe->frame.lines, lines);
  for (const CovisibleKeyFrame& other : ClosestCovisible(map, id, neighbours)) {
    local.neighbours.push_back(other.id);
    AddValid(map.Find(other.id)->frame.points, points);
    AddValid(map.Find(other.id)->frame.lines, lines);
  }
  local.points = Resolve<MapPoint>(map, points);
  local.lines = Resolve<MapLine>(map, lines);
  return local;
}

CameraPoint PointInCamera(const RectifiedCamera& camera,
                          const Map& map,
                          const MapPoint& point,
                          const Rigid3& cam_from_world) {
  constexpr std::size_t kNewest = 8;
  CameraPoint out;
  out.place = cam_from_world * point.position;
  const double distance2 = std::max(out.place.squaredNorm(), 1e-12);
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / distance2;
  const Observations& seen = point.observations;
  const auto skip = static_cast<std::ptrdiff_t>(seen.size() - std::min(seen.size(), kNewest));
  for (auto it = seen.begin() + skip; it != seen.end(); ++it) {
    const KeyFrame* keyframe = map.Find(it->first);
    if (keyframe == nullptr) continue;
    const auto residual = EvaluatePoint(
        camera,
        keyframe->frame.cam_from_world,
        point.position,
        MeasurePoint(keyframe->frame.features(), static_cast<std::size_t>(it->second)));
    if (residual) information += residual->J_point.transpose() * residual->J_point;
  }
  const Eigen::Matrix3d turn = cam_from_world.rotation.toRotationMatrix();
  out.covariance = turn * information.ldlt().solve(turn.transpose());
  return out;
}

LineModel LineInCamera(const MapLine& line, const Rigid3& cam_from_world) {
  LineModel in_camera = line;
  Move(ToSimilarity(cam_from_world), in_camera);
  return in_camera;
}

Rigid3 CameraAmong(const Rigid3& keyframe_from_world, const Similarity3& camera_from_keyframe) {
  const Rigid3 step{camera_from_keyframe.rotation,
                    camera_from_keyframe.translation / camera_from_keyframe.scale};
  return step * keyframe_from_world;
}

SearchedImage SearchImage(const CameraAndPyramid& imaging,
                          const LocalLandmarks& landmarks,
                          const Rigid3& cam_from_world,
                          const FrameFeatures& image,
                          const ProjectionSearchOptions& options) {
  SearchedImage out;
  out.projected_points.reserve(landmarks.points.size());
  for (const MapPoint* point : landmarks.points) {
    out.projected_points.push_back(ProjectPoint(imaging, cam_from_world, *point));
    out.tested_points += out.projected_points.back().has_value();
  }
  out.projected_lines.reserve(landmarks.lines.size());
  for (const MapLine* line : landmarks.lines) {
    out.projected_lines.push_back(ProjectLine(imaging, cam_from_world, *line));
    out.tested_lines += out.projected_lines.back().has_value();
  }
  const std::vector<bool> no_point(image.features.points.size(), false);
  const std::vector<bool> no_line(image.features.lines.size(), false);
  out.points = MatchProjectedPoints(image, out.projected_points, no_point, options);
  out.lines = MatchProjectedLines(image, out.projected_lines, no_line, options);
  return out;
}

}  // namespace plumbline
