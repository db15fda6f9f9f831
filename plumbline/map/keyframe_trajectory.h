// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/map/map.h"

#include <Eigen/Geometry>

namespace plumbline {

// Returns the poses of the left camera as delivered at the keyframes of a map, in order of time. A
// trajectory has one pose at a time: of several keyframes of one time, which a merged map may have,
// it has the one with the lowest number.
//
//   rectified_from_left  rotation from the camera as delivered to the one in which the map's
//                        features are
Trajectory KeyFrameTrajectory(const Map& map, const Eigen::Quaterniond& rectified_from_left);

}  // namespace plumbline
