// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

// Eigenvalues and eigenvectors of small symmetric matrices, by Eigen's SelfAdjointEigenSolver. Each
// size is compiled once, in eigenpairs.cc, since each instantiation takes a compiler up to five
// seconds. Only the lower triangle of a matrix is read.
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

}  // namespace plumbline
