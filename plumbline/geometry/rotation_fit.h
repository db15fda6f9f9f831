// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

struct RotationFit {
  Eigen::Matrix3d rotation;
  // Singular values of the correlation, the largest first. The last one is given a negative sign
  // where a reflection would fit the vectors better than any rotation. The rotation is determined
  // only where the sum of the last two is positive.
  Eigen::Vector3d singular_values;
};

// Returns the rotation R that turns vectors s_i best into t_i, from their correlation sum w_i t_i
// s_i^T. It maximises trace(R^T correlation), and so minimises sum w_i |t_i - R s_i|^2.
//
// Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI
// 1991, eq. 40 and 43.
RotationFit FitRotation(const Eigen::Matrix3d& correlation);

}  // namespace plumbline
