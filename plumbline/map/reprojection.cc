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

}  // namespace plumbline
