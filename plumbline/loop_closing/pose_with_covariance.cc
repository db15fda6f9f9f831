// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/pose_with_covariance.h"

#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {

PoseWithCovariance Compose(const PoseWithCovariance& c_from_b, const PoseWithCovariance& b_from_a) {
  const Matrix7d moved = Adjoint(c_from_b.pose);
  return {c_from_b.pose * b_from_a.pose,
          c_from_b.covariance + moved * b_from_a.covariance * moved.transpose()};
}

PoseWithCovariance Inverse(const PoseWithCovariance& b_from_a) {
  const Similarity3 inverse = Inverse(b_from_a.pose);
  const Matrix7d moved = Adjoint(inverse);
  return {inverse, moved * b_from_a.covariance * moved.transpose()};
}

double ClosingChi2(const PoseWithCovariance& a_from_a) {
  const Eigen::Index size = a_from_a.covariance(6, 6) > 0 ? 7 : 6;
  const Eigen::LLT<Eigen::MatrixXd> factor(a_from_a.covariance.topLeftCorner(size, size));
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd r = LogSim3(a_from_a.pose).head(size);
  return r.dot(factor.solve(r));
}

}  // namespace plumbline
