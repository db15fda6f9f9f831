// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/symmetric_system.h"

#include <Eigen/Cholesky>

namespace plumbline {

template <int N>
Eigen::Matrix<double, N, 1> SolveSymmetric(const Eigen::Matrix<double, N, N>& matrix,
                                           const Eigen::Matrix<double, N, 1>& right) {
  return Eigen::LDLT<Eigen::Matrix<double, N, N>, Eigen::Lower>(matrix).solve(right);
}

template <int N>
std::optional<Eigen::Matrix<double, N, N>> InverseOfInformation(
    const Eigen::Matrix<double, N, N>& information, double min_rcond) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::LLT<Square> factor(information);
  if (factor.info() != Eigen::Success || !(factor.rcond() > min_rcond)) return std::nullopt;
  return Square(factor.solve(Square::Identity()));
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
