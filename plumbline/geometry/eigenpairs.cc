// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/eigenpairs.h"

#include <Eigen/Eigenvalues>

namespace plumbline {

template <int N>
Eigenpairs<N> EigenpairsOf(const Eigen::Matrix<double, N, N>& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int N>
Eigen::Matrix<double, N, 1> EigenvaluesOf(const Eigen::Matrix<double, N, N>& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>>(symmetric,
                                                                    Eigen::EigenvaluesOnly)
      .eigenvalues();
}

template Eigenpairs<2> EigenpairsOf(const Eigen::Matrix<double, 2, 2>&);
template Eigenpairs<3> EigenpairsOf(const Eigen::Matrix<double, 3, 3>&);
template Eigenpairs<4> EigenpairsOf(const Eigen::Matrix<double, 4, 4>&);
template Eigenpairs<5> EigenpairsOf(const Eigen::Matrix<double, 5, 5>&);
template Eigenpairs<6> EigenpairsOf(const Eigen::Matrix<double, 6, 6>&);
template Eigenpairs<9> EigenpairsOf(const Eigen::Matrix<double, 9, 9>&);
template Eigen::Matrix<double, 2, 1> EigenvaluesOf(const Eigen::Matrix<double, 2, 2>&);
template Eigen::Matrix<double, 3, 1> EigenvaluesOf(const Eigen::Matrix<double, 3, 3>&);
template Eigen::Matrix<double, 4, 1> EigenvaluesOf(const Eigen::Matrix<double, 4, 4>&);
template Eigen::Matrix<double, 6, 1> EigenvaluesOf(const Eigen::Matrix<double, 6, 6>&);
template Eigen::Matrix<double, 9, 1> EigenvaluesOf(const Eigen::Matrix<double, 9, 9>&);

}  // namespace plumbline
