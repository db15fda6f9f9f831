// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Normal equations of a few unknowns, by Eigen's LDL^T and LL^T. Each size is compiled once, in
// symmetric_system.cc, since each instantiation takes a compiler some seconds. Only the lower
// triangle of a matrix is read.

// Returns x with matrix x = right, by LDL^T. N: 3, 4, 5, 6. If the matrix is singular, undetermined
// unknowns are zero or not finite.
template <int N>
Eigen::Matrix<double, N, 1> SolveSymmetric(const Eigen::Matrix<double, N, N>& matrix,
                                           const Eigen::Matrix<double, N, 1>& right);

// Returns the inverse of an information matrix, by LL^T; nullopt unless it is positive definite and
// the reciprocal of its condition number exceeds min_rcond. N: 3, 4, 5.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> InverseOfInformation(
    const Eigen::Matrix<double, N, N>& information, double min_rcond);

}  // namespace plumbline
