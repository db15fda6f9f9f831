// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// Returns the standard deviation in the worst direction: the square root of the largest eigenvalue.
// Infinite if the covariance is not finite.
double LargestSigma(const Eigen::Matrix3d& covariance);

// Returns the covariance of world_from_camera from that of the left perturbation [rotation,
// translation] of cam_from_world (docs/adr/0002-frames-units-tangents.md). The result is of [x, y,
// z, rotation about x, y, z], all along the axes of the world: the true camera centre is the
// estimated one plus d, and the true rotation of world_from_camera is Exp(w) times the estimated
// one. This is the order and meaning of ROS's geometry_msgs/PoseWithCovariance. Exactly symmetric.
//
// A rotation of the camera about its own centre, such as rectification, does not change the result.
Matrix6d PoseCovarianceInWorld(const Rigid3& cam_from_world, const Matrix6d& of_left_perturbation);

// Returns the covariance, in the form of PoseCovarianceInWorld, of a body that is fixed to the
// camera, along the axes of another world.
//
//   covariance        of the camera in the world
//   other_from_world  rotates the axes; the motion between the two worlds is known exactly, and the
//                     origin of the other one does not matter
//   lever             from the camera's centre to the body's origin, along the axes of the world
Matrix6d MovedPoseCovariance(const Matrix6d& covariance,
                             const Eigen::Quaterniond& other_from_world,
                             const Eigen::Vector3d& lever);

}  // namespace plumbline
