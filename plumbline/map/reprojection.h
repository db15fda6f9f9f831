// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"

#include <optional>
#include <vector>

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

// Returns true if the observations of a point tell its distance to a half or better, the poses
// taken as exact: they lie off those of a point infinitely far in the same direction by two
// standard deviations in all. Where they do not, the point can stand anywhere along its ray, with a
// single camera a million times as far as all others; it still tells how the camera turns.
bool HasKnownDistance(const RectifiedCamera& camera, const Map& map, const MapPoint& point);

// Returns the points that other programs are given, those of a known distance, in the order of
// their ids; valid as long as the map is unchanged. Takes some microseconds for each point.
std::vector<const MapPoint*> PointsOfKnownDistance(const RectifiedCamera& camera, const Map& map);

}  // namespace plumbline
