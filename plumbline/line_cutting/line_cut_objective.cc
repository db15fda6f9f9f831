// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/line_cut_objective.h"

#include "plumbline/base/elementary.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Returns the coefficients of (1, a, a^2) in (w0 + a w1)^T Sigma (w0 + a w1).
Vector3d QuadraticForm(const Vector3d& w0, const Vector3d& w1, const Matrix3d& sigma) {
  const Vector3d s0 = sigma * w0;
  return {w0.dot(s0), 2 * w1.dot(s0), w1.dot(sigma * w1)};
}

}  // namespace

IndependentLineObjective::IndependentLineObjective(const RectifiedCamera& camera,
                                                   const CuttableLine& line,
                                                   const Matrix6d& rest) {
  const Vector3d& l = line.image_line;
  const Vector3d q(
      l.x() * camera.fx, l.y() * camera.fy, l.x() * camera.cx + l.y() * camera.cy + l.z());
  const Vector3d& x = line.segment_in_cam.start;
  const Vector3d d = line.segment_in_cam.end - x;
  depth_ = x.z();
  depth_by_ratio_ = d.z();
  noise_ = line.sigma_px * line.sigma_px;
  // w = z^2 g = z q - (q . X) e_z is linear in the ratio.
  const Vector3d w0 = x.z() * q - q.dot(x) * Vector3d::UnitZ();
  const Vector3d w1 = d.z() * q - q.dot(d) * Vector3d::UnitZ();
  start_variance_ = QuadraticForm(w0, w1, line.start_covariance);
  end_variance_ = QuadraticForm(w0, w1, line.end_covariance);
  Eigen::Matrix<double, 6, 3> p;
  p.col(0) << x.cross(w0), w0;
  p.col(1) << d.cross(w0) + x.cross(w1), w1;
  p.col(2) << d.cross(w1), Vector3d::Zero();
  const Eigen::LLT<Matrix6d> factor(rest);
  factor.matrixL().solveInPlace(p);
  gram_.noalias() = p.transpose() * p;
}

IndependentLineObjective::Point IndependentLineObjective::At(double a) const {
  Point out;
  const double b = 1 - a;
  out.power = {1, a, a * a};
  out.power_by_ratio = {0, 1, 2 * a};
  const double z = depth_ + a * depth_by_ratio_;
  const double z3 = z * z * z;
  const double start = start_variance_.dot(out.power);
  const double end = end_variance_.dot(out.power);
  out.variance = b * b * start + a * a * end + z3 * z * noise_;
  out.variance_by_ratio = -2 * b * start + b * b * start_variance_.dot(out.power_by_ratio) +
                          2 * a * end + a * a * end_variance_.dot(out.power_by_ratio) +
                          4 * z3 * depth_by_ratio_ * noise_;
  return out;
}

double IndependentLineObjective::operator()(const Vector2d& ratios, Vector2d& gradient) const {
  const Point p = At(ratios(0)), q = At(ratios(1));
  const Vector3d gp = gram_ * p.power, gq = gram_ * q.power;
  const double ip = 1 / p.variance, iq = 1 / q.variance;
  // The 2 x 2 determinant is (1 + pp)(1 + qq) - pq^2.
  const double pp = p.power.dot(gp) * ip;
  const double qq = q.power.dot(gq) * iq;
  const double pq = p.power.dot(gq);
  const double pq2 = pq * pq * ip * iq;
  const double determinant = (1 + pp) * (1 + qq) - pq2;
  const double pp_slope = (2 * p.power_by_ratio.dot(gp) - pp * p.variance_by_ratio) * ip;
  const double qq_slope = (2 * q.power_by_ratio.dot(gq) - qq * q.variance_by_ratio) * iq;
  const double cross = 2 * pq * ip * iq;
  gradient = {
      pp_slope * (1 + qq) - cross * p.power_by_ratio.dot(gq) + pq2 * p.variance_by_ratio * ip,
      qq_slope * (1 + pp) - cross * q.power_by_ratio.dot(gp) + pq2 * q.variance_by_ratio * iq};
  gradient /= determinant;
  return math::Log(determinant);
}

double GeneralLineObjective::operator()(const Vector2d& ratios, Vector2d& gradient) const {
  const CutResiduals residuals =
      EvaluateCut(problem_.camera, problem_.lines[line_], {ratios(0), ratios(1)}, information_);
  InformationSums sums = rest_;
  sums.Add(residuals);
  const LogDeterminant log_det =
      EvaluateLogDeterminant(sums, problem_.other_information, information_);
  gradient = log_det.ByRatios(residuals);
  return log_det.value;
}

}  // namespace plumbline
