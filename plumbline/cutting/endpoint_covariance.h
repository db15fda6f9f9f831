// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"

#include <Eigen/Core>

namespace plumbline {

// Returns the covariance (3 x 3, m^2, camera frame) of a point whose column and row in the image
// are known to sigma_px and whose inverse depth is known to sigma_inverse_depth (1/m), all three
// independent: "constant in inverse depth" of the second paper, section 6. To first order, with X =
// (u, v, 1)/rho: dX/du = e_x z / fx, dX/dv = e_y z / fy, dX/drho = -z X. `point_in_cam` must have z
// > 0.
//
// For a point measured in an earlier camera, compute that camera's covariance and turn it into the
// present one: R Sigma R^T with R of cam_from_earlier.
Eigen::Matrix3d CovarianceFromInverseDepth(const RectifiedCamera& camera,
                                           const Eigen::Vector3d& point_in_cam,
                                           double sigma_px,
                                           double sigma_inverse_depth);

// Returns the covariance of a point from a stereo pair or a depth image. The disparity fx *
// baseline / z is known to sigma_disparity_px, and so the inverse depth to sigma_disparity_px / (fx
// * baseline). The camera's baseline must be positive.
Eigen::Matrix3d CovarianceFromDisparity(const RectifiedCamera& camera,
                                        const Eigen::Vector3d& point_in_cam,
                                        double sigma_px,
                                        double sigma_disparity_px);

}  // namespace plumbline
