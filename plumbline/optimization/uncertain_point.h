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

// A measurement of a point whose place has a covariance of its own.
struct UncertainPointTerm {
  PointTerm term;             // with weights of one: residuals in pixels
  Eigen::Matrix3d whitening;  // of these residuals; lower triangular
};

// The covariance of the residual is that of the measurement and of the point's projection,
// S = diag(sigma^2) + J Sigma J^T, at the given pose; its inverse Cholesky factor whitens. nullopt
// when the point is not in front of the camera, or so near that S is singular to working precision,
// and without covariance (zero).
//
//   point_covariance  of the place in the world, map units squared; positive semidefinite
std::optional<UncertainPointTerm> MakeUncertainPointTerm(const RectifiedCamera& camera,
                                                         const Rigid3& cam_from_world,
                                                         const Eigen::Vector3d& point_in_world,
                                                         const Eigen::Matrix3d& point_covariance,
                                                         const PointMeasurement& measurement);

// Residual and derivatives of a match at a pose, whitened with the covariance of measurement and
// point there. nullopt when the point is not in front of the camera, as above.
std::optional<PointResidual> EvaluateMatch(const RectifiedCamera& camera,
                                           const Rigid3& cam_from_world,
                                           const PoseProblem::PointMatch& match);

}  // namespace plumbline
