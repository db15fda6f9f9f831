// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"

namespace plumbline {

// A relative pose b_from_a with the covariance of its left perturbation [rotation, translation, log
// scale]. For a rigid motion the last row and column are zero.
struct PoseWithCovariance {
  Similarity3 pose;
  Matrix7d covariance = Matrix7d::Zero();
};

// Returns c_from_b * b_from_a; the estimates count as independent, to first order.
PoseWithCovariance Compose(const PoseWithCovariance& c_from_b, const PoseWithCovariance& b_from_a);

// Returns a_from_b with the covariance of b_from_a propagated to first order.
PoseWithCovariance Inverse(const PoseWithCovariance& b_from_a);

// Returns the squared Mahalanobis norm of Log(pose): the closing error of a cycle of relative
// poses. Rigid motions (no variance of the scale) have six degrees of freedom, others seven.
// Infinite if the covariance is not positive definite.
double ClosingChi2(const PoseWithCovariance& a_from_a);

}  // namespace plumbline
