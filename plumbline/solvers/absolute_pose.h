// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>
#include <vector>

namespace plumbline {

struct PointInImage {
  Eigen::Vector3d world;
  Eigen::Vector2d px;
};

// Returns the pose (cam_from_world) that best fits the points: RANSAC over three points (Grunert
// 1841) in at most 300 rounds; every new best pose is refined with its inliers (ransac.h). Inliers
// project within max_error_px of their pixels. The same input gives the same pose.
//
// Returns nullopt for fewer than 6 points or inliers. Cost: less than a millisecond for 100 points.
std::optional<Rigid3> PoseFromPoints(const RectifiedCamera& camera,
                                     const std::vector<PointInImage>& points,
                                     double max_error_px);

}  // namespace plumbline
