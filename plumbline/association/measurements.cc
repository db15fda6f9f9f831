// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/association/measurements.h"

#include "plumbline/optimization/residuals.h"

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr double kUnknownLineSigma = 0.5;  // radians

LineMeasurement Measure(const Segment2& segment, double sigma_px, LineWeighting weighting) {
  const double sigma = weighting == LineWeighting::kNone ? 1.0 : sigma_px;
  return {segment, sigma * sigma * Eigen::Matrix2d::Identity(), false};
}

}  // namespace

PointMeasurement MeasurePoint(const Features& features, std::size_t i) {
  return {features.points[i].px, features.points[i].sigma_px, features.point_disparity[i]};
}

LineMeasurement MeasureLeftLine(const Features& features, std::size_t i, LineWeighting weighting) {
  return Measure(features.lines[i].segment, features.lines[i].sigma_px, weighting);
}

std::optional<LineMeasurement> MeasureRightLine(const Features& features,
                                                std::size_t i,
                                                LineWeighting weighting) {
  const auto& right = features.line_right[i];
  if (!right) return std::nullopt;
  LineMeasurement measurement = Measure(right->segment, right->sigma_px, weighting);
  measurement.in_right_camera = true;
  return measurement;
}

void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const PluckerLine& line,
                            const Eigen::Matrix4d& information,
                            LineWeighting weighting,
                            LineMeasurement& measurement) {
  if (weighting == LineWeighting::kNone) return;
  LineMeasurement unit = measurement;
  unit.covariance = Eigen::Matrix2d::Identity();
  const auto residual = EvaluateLine(camera, cam_from_world, ToOrthonormal(line), unit);
  if (!residual) return;
  const Eigen::Matrix4d regularized =
      information + Eigen::Matrix4d::Identity() / (kUnknownLineSigma * kUnknownLineSigma);
  const Eigen::Matrix<double, 4, 2> spread = regularized.llt().solve(residual->J_line.transpose());
  measurement.covariance += residual->J_line * spread;
  if (weighting == LineWeighting::kScalar) {
    measurement.covariance = 0.5 * measurement.covariance.trace() * Eigen::Matrix2d::Identity();
  }
}

}  // namespace plumbline
