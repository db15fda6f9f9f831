// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/map/map.h"

#include <Eigen/Geometry>

namespace plumbline {

// Poses of the left camera as delivered at the keyframes of a map, in the order of time. A
// trajectory has one pose at a time: of keyframes of one time, which a merged map may have, it has
// the one with the lowest number.
//
//   rectified_from_left  of the camera as delivered to the one that the map's features are in
Trajectory KeyFrameTrajectory(const Map& map, const Eigen::Quaterniond& rectified_from_left);

}  // namespace plumbline
