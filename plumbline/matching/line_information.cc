// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/line_information.h"

#include "plumbline/geometry/covariance.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {

Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PluckerLine& line) {
  return LineInformation(camera, frame, i, PreparedLine(ToOrthonormal(line)));
}

Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PreparedLine& line) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  const auto add = [&](const LineMeasurement& measurement) {
    const auto residual = EvaluateLine(camera, frame.cam_from_world, line, measurement);
    if (residual) information += residual->J_line.transpose() * residual->J_line;
  };
  add(MeasureLeftLine(frame.features(), i, LineWeighting::kCovariance));
  if (const auto right = MeasureRightLine(frame.features(), i, LineWeighting::kCovariance)) {
    add(*right);
  }
  return information;
}

Eigen::Matrix<double, 3, 4> ShiftJacobian(const PluckerLine& line,
                                          const OrthonormalLine& orthonormal,
                                          double t) {
  // The moment about a point P of the line is m - P x d = 0. A shift x of the line across itself
  // makes it x X d, so that x = d X (dm - P X dd), with (m, d) scaled to |d| = 1.
  const Eigen::Matrix<double, 6, 4> J = HomogeneousJacobian(orthonormal);
  const Eigen::Matrix<double, 3, 4> moment_about_p =
      (J.topRows<3>() - Skew(line.PointAt(t)) * J.bottomRows<3>()) / orthonormal.w.y();
  return Skew(line.direction) * moment_about_p;
}

double SigmaAt(const PluckerLine& line, const Eigen::Matrix4d& information, double t) {
  const Eigen::LLT<Eigen::Matrix4d> factor(information);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::Matrix<double, 3, 4> J_shift = ShiftJacobian(line, ToOrthonormal(line), t);
  return LargestSigma(J_shift * factor.solve(J_shift.transpose()));
}

}  // namespace plumbline
