// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"

#include <optional>

namespace plumbline {

// Returns the distance in pixels between a feature of a frame's left image and the projection of a
// point of the world. Returns nullopt if the point is not in front of the camera.
std::optional<double> ReprojectionError(const RectifiedCamera& camera,
                                        const Frame& frame,
                                        int feature,
                                        const Eigen::Vector3d& in_world);

// Returns the mean reprojection error over the keyframes that show the point; nullopt if the point
// is in front of none of them.
std::optional<double> MeanReprojectionError(const RectifiedCamera& camera,
                                            const Map& map,
                                            const MapPoint& point);

}  // namespace plumbline
