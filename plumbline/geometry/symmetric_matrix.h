// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Small symmetric matrices, decomposed by Eigen. One decomposition in symmetric_matrix.cc serves
// all sizes, since each instantiation takes a compiler up to ten seconds. Only the lower triangle
// of a matrix is read.

// Eigenvalues and eigenvectors, by Eigen's SelfAdjointEigenSolver.
template <int N>
struct Eigenpairs {
  Eigen::Matrix<double, N, 1> values;   // ascending
  Eigen::Matrix<double, N, N> vectors;  // one in each column, of unit length
};

// N: 2, 3, 4, 6, 9. A matrix that is not finite has non-finite eigenvalues.
template <int N>
Eigenpairs<N> EigenpairsOf(const Eigen::Matrix<double, N, N>& symmetric);

// The eigenvalues alone, ascending.
template <int N>
Eigen::Matrix<double, N, 1> EigenvaluesOf(const Eigen::Matrix<double, N, N>& symmetric);

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
