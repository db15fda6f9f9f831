// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/measurements.h"

#include "plumbline/geometry/covariance.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {

Eigen::Matrix4d RegularizedInformation(const Eigen::Matrix4d& information) {
  constexpr double kUnknownLineSigma = 0.5;  // radians
  return information + Eigen::Matrix4d::Identity() / (kUnknownLineSigma * kUnknownLineSigma);
}

UncertainLine::UncertainLine(const PluckerLine& line, const Eigen::Matrix4d& information_of_it)
    : prepared(ToOrthonormal(line)), information(RegularizedInformation(information_of_it)) {}

namespace {

LineMeasurement Measure(const Segment2& segment, double sigma_px, const LineWeights& weights) {
  const double sigma = weights.kind == LineWeighting::kNone ? weights.constant_sigma_px : sigma_px;
  return {segment, sigma * sigma * Eigen::Matrix2d::Identity(), false};
}

// Returns J Lambda^-1 J^T.
Eigen::Matrix2d SpreadOf(const Eigen::Matrix<double, 2, 4>& J,
                         const Eigen::LLT<Eigen::Matrix4d>& information) {
  const Eigen::Matrix<double, 4, 2> spread = information.solve(J.transpose());
  return J * spread;
}

// Returns J Lambda^-1 J^T, computed as a square so that rounding errors leave it positive, and
// bounded to meaningful values.
Eigen::Matrix2d BoundedSpreadOf(const Eigen::Matrix<double, 2, 4>& J,
                                const Eigen::LLT<Eigen::Matrix4d>& information) {
  constexpr double kMaxSpread = 1e8;  // square pixels: wider than any image
  Eigen::Matrix<double, 4, 2> root = information.matrixL().solve(J.transpose());
  root *= std::sqrt(std::min(1.0, kMaxSpread / root.squaredNorm()));
  return root.transpose() * root;
}

void MakeScalar(const LineWeights& weights, Eigen::Matrix2d& covariance) {
  if (weights.kind != LineWeighting::kScalar) return;
  covariance = 0.5 * covariance.trace() * Eigen::Matrix2d::Identity();
}

}  // namespace

PointMeasurement MeasurePoint(const Features& features, std::size_t i) {
  return {features.points[i].px, features.points[i].sigma_px, features.point_disparity[i]};
}

LineMeasurement MeasureLeftLine(const Features& features,
                                std::size_t i,
                                const LineWeights& weights) {
  return Measure(features.lines[i].segment, features.lines[i].sigma_px, weights);
}

std::optional<LineMeasurement> MeasureRightLine(const Features& features,
                                                std::size_t i,
                                                const LineWeights& weights) {
  const auto& right = features.line_right[i];
  if (!right) return std::nullopt;
  LineMeasurement measurement = Measure(right->segment, right->sigma_px, weights);
  measurement.camera = 1;
  return measurement;
}

void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const PluckerLine& line,
                            const Eigen::Matrix4d& information,
                            const LineWeights& weights,
                            LineMeasurement& measurement) {
  if (weights.kind == LineWeighting::kNone) return;
  AddLandmarkUncertainty(
      camera, cam_from_world, UncertainLine(line, information), weights, measurement);
}

void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const UncertainLine& line,
                            const LineWeights& weights,
                            LineMeasurement& measurement) {
  if (weights.kind == LineWeighting::kNone) return;
  LineMeasurement unit = measurement;
  unit.covariance = Eigen::Matrix2d::Identity();
  const auto residual = EvaluateLine(camera, cam_from_world, line.prepared, unit);
  if (!residual) return;
  const Eigen::Matrix2d noise = measurement.covariance;
  measurement.covariance += SpreadOf(residual->J_line, line.information);
  // The spread of a line that is seen end on is so wide that rounding errors outgrow the noise.
  if (!IsPositiveDefinite(measurement.covariance)) {
    measurement.covariance = noise + BoundedSpreadOf(residual->J_line, line.information);
  }
  MakeScalar(weights, measurement.covariance);
}

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
