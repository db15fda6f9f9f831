// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"

#include <optional>

namespace plumbline {

// Distance in pixels between a feature of a frame's left image and the place where a point of the
// world appears in it. nullopt where the point is not before the camera.
std::optional<double> ReprojectionError(const RectifiedCamera& camera,
                                        const Frame& frame,
                                        int feature,
                                        const Eigen::Vector3d& in_world);

// The mean of these distances over the keyframes that show the point. nullopt where it is before
// none of them.
std::optional<double> MeanReprojectionError(const RectifiedCamera& camera,
                                            const Map& map,
                                            const MapPoint& point);

}  // namespace plumbline
