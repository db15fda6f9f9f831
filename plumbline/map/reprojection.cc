// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/reprojection.h"

#include <cstddef>

namespace plumbline {

std::optional<double> ReprojectionError(const RectifiedCamera& camera,
                                        const Frame& frame,
                                        int feature,
                                        const Eigen::Vector3d& in_world) {
  const Eigen::Vector3d in_camera = frame.cam_from_world * in_world;
  if (!(in_camera.z() > 0)) return std::nullopt;
  const PointFeature& measured = frame.features().points[static_cast<std::size_t>(feature)];
  return (camera.Project(in_camera) - measured.px).norm();
}

std::optional<double> MeanReprojectionError(const RectifiedCamera& camera,
                                            const Map& map,
                                            const MapPoint& point) {
  double sum = 0;
  int count = 0;
  for (const auto& [id, feature] : point.observations) {
    const auto error = ReprojectionError(camera, map.Find(id)->frame, feature, point.position);
    if (!error) continue;
    sum += *error;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

bool HasKnownDistance(const RectifiedCamera& camera, const Map& map, const MapPoint& point) {
  constexpr double kLeastSquaredSigmas = 4;
  if (point.observations.empty()) return false;
  const KeyFrame& first = *map.Find(point.observations.begin()->first);
  const Eigen::Vector3d ray =
      point.position - Inverse(first.frame.cam_from_world).translation;  // of the first keyframe
  // Parallax: the spread of what tells a keyframe's view of the point from that of the ray's far
  // end, since a common shift is another direction of the ray.
  double weights = 0, squares = 0, disparities = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& [id, feature] : point.observations) {
    const Frame& frame = map.Find(id)->frame;
    const auto i = static_cast<std::size_t>(feature);
    const Eigen::Vector3d here = frame.cam_from_world * point.position;
    const Eigen::Vector3d far = frame.cam_from_world.rotation * ray;
    if (!(here.z() > 0)) continue;
    if (!(far.z() > 0)) return true;  // seen from the other side
    const double sigma = frame.features().points[i].sigma_px;
    const Eigen::Vector2d shift = camera.Project(here) - camera.Project(far);
    const double weight = 1 / (sigma * sigma);
    weights += weight;
    sum += weight * shift;
    squares += weight * shift.squaredNorm();
    if (const auto disparity = frame.features().point_disparity[i]) {
      const double sigmas = camera.DisparityFromDepth(here.z()) / disparity->sigma_px;
      disparities += sigmas * sigmas;
    }
  }
  if (!(weights > 0)) return false;
  return squares - sum.squaredNorm() / weights + disparities >= kLeastSquaredSigmas;
}

std::vector<const MapPoint*> PointsOfKnownDistance(const RectifiedCamera& camera, const Map& map) {
  std::vector<const MapPoint*> known;
  for (const auto& [id, point] : map.points()) {
    if (HasKnownDistance(camera, map, point)) known.push_back(&point);
  }
  return known;
}

}  // namespace plumbline
