// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/map/map.h"

#include <Eigen/Geometry>

namespace plumbline {

// Returns the poses of the left camera as delivered at the keyframes of a map, in order of time. Of
// several keyframes with one stamp, which a merged map may have, only the one with the lowest
// number is used.
//
//   rectified_from_left  rotation from the camera as delivered to that of the map's features
Trajectory KeyFrameTrajectory(const Map& map, const Eigen::Quaterniond& rectified_from_left);

}  // namespace plumbline
