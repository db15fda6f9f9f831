// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

struct RotationFit {
  Eigen::Matrix3d rotation;
  // Singular values of the correlation, the largest first. The last one is negative if a reflection
  // fits better than any rotation. The rotation is determined only if the sum of the last two is
  // positive.
  Eigen::Vector3d singular_values;
};

// Returns the rotation R that best aligns vectors s_i with t_i, from their correlation sum w_i t_i
// s_i^T. It maximises trace(R^T correlation), and so minimises sum w_i |t_i - R s_i|^2.
//
// Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI
// 1991, eq. 40 and 43.
RotationFit FitRotation(const Eigen::Matrix3d& correlation);

}  // namespace plumbline
