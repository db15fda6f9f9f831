// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// A measurement of a point whose position has a covariance.
struct UncertainPointTerm {
  PointTerm term;             // its weights are one, so that residuals are in pixels
  Eigen::Matrix3d whitening;  // whitens these residuals; lower triangular
};

// Returns the term of a point measurement at the given pose. The covariance of the residual is that
// of the measurement plus that of the point's projection, S = diag(sigma^2) + J Sigma J^T; its
// inverse Cholesky factor whitens. Returns nullopt if the point has no covariance (zero), is not in
// front of the camera, or is so near that S is singular to working precision.
//
//   point_covariance  of the position in the world, map scale squared; positive semidefinite
std::optional<UncertainPointTerm> MakeUncertainPointTerm(const RectifiedCamera& camera,
                                                         const Rigid3& cam_from_world,
                                                         const Eigen::Vector3d& point_in_world,
                                                         const Eigen::Matrix3d& point_covariance,
                                                         const PointMeasurement& measurement);

// Returns residual and derivatives of a match at a pose, whitened with the covariance of
// measurement and point there. Returns nullopt if the point is not in front of the camera, or so
// near that its covariance is singular to working precision.
std::optional<PointResidual> EvaluateMatch(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const PoseProblem::PointMatch& match);

}  // namespace plumbline
