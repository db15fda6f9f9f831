// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/measurements.h"

#include "plumbline/matching/uncertain_line.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace plumbline {
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

}  // namespace plumbline
