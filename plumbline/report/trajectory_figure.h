// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/figure.h"
#include "plumbline/report/trajectory_error.h"

#include <span>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A comparison to draw, and the name of its estimate.
struct NamedError {
  std::string name;
  const TrajectoryError* error = nullptr;
};

// Returns roll, pitch and yaw in degrees: rotation = Rz(yaw) Ry(pitch) Rx(roll), rotations about
// the fixed axes x, y and z, one after the other. Pitch is within 90 degrees of 0; at its ends roll
// and yaw are not determined separately.
Eigen::Vector3d RollPitchYawDeg(const Eigen::Quaterniond& rotation);

// Returns the two axes with the largest motion of the reference, in their order x, y, z. The third
// one is up in most worlds.
std::pair<int, int> AxesOfMostMotion(std::span<const EvaluatedPose> poses);

// Draws evaluated trajectories with their references: from above ("above" is along the axis in
// which the reference of the first one moves least), the position errors over time, and over time
// x, y, z, roll, pitch and yaw of the camera (world_from_camera) in the world of the reference.
// Time begins with the earliest pose. Estimates without poses are skipped.
Figure TrajectoryFigure(std::span<const NamedError> errors);
// Draws one comparison, named "estimate".
Figure TrajectoryFigure(const TrajectoryError& error);

}  // namespace plumbline
