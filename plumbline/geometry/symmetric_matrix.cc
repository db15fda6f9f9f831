// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/symmetric_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace plumbline {

namespace {

// A matrix of any size up to 9 rows, without memory from the heap.
using UpTo9 = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 9, 9>;

}  // namespace

template <int N>
Eigenpairs<N> EigenpairsOf(const Eigen::Matrix<double, N, N>& symmetric) {
  const Eigen::SelfAdjointEigenSolver<UpTo9> solver{UpTo9(symmetric)};
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int N>
Eigen::Matrix<double, N, 1> EigenvaluesOf(const Eigen::Matrix<double, N, N>& symmetric) {
  return Eigen::SelfAdjointEigenSolver<UpTo9>(UpTo9(symmetric), Eigen::EigenvaluesOnly)
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

template <int N>
Eigen::Matrix<double, N, 1> SolveSymmetric(const Eigen::Matrix<double, N, N>& matrix,
                                           const Eigen::Matrix<double, N, 1>& right) {
  return Eigen::LDLT<UpTo9, Eigen::Lower>(UpTo9(matrix)).solve(UpTo9(right));
}

template <int N>
std::optional<Eigen::Matrix<double, N, N>> InverseOfInformation(
    const Eigen::Matrix<double, N, N>& information, double min_rcond) {
  const Eigen::LLT<UpTo9> factor{UpTo9(information)};
  if (factor.info() != Eigen::Success || !(factor.rcond() > min_rcond)) return std::nullopt;
  return Eigen::Matrix<double, N, N>(factor.solve(UpTo9(UpTo9::Identity(N, N))));
}

template Eigen::Matrix<double, 3, 1> SolveSymmetric(const Eigen::Matrix<double, 3, 3>&,
                                                    const Eigen::Matrix<double, 3, 1>&);
template Eigen::Matrix<double, 4, 1> SolveSymmetric(const Eigen::Matrix<double, 4, 4>&,
                                                    const Eigen::Matrix<double, 4, 1>&);
template Eigen::Matrix<double, 5, 1> SolveSymmetric(const Eigen::Matrix<double, 5, 5>&,
                                                    const Eigen::Matrix<double, 5, 1>&);
template Eigen::Matrix<double, 6, 1> SolveSymmetric(const Eigen::Matrix<double, 6, 6>&,
                                                    const Eigen::Matrix<double, 6, 1>&);
template std::optional<Eigen::Matrix<double, 3, 3>> InverseOfInformation(
    const Eigen::Matrix<double, 3, 3>&, double);
template std::optional<Eigen::Matrix<double, 4, 4>> InverseOfInformation(
    const Eigen::Matrix<double, 4, 4>&, double);
template std::optional<Eigen::Matrix<double, 5, 5>> InverseOfInformation(
    const Eigen::Matrix<double, 5, 5>&, double);

}  // namespace plumbline
