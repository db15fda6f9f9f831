// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/pose_from_lines.h"

#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/line_cutting/cut_residuals.h"

#include <limits>

namespace plumbline {
namespace {

constexpr int kIterations = 50;
constexpr int kPointIterations = 5;
constexpr double kMinDepth = 0.05;  // m; a step that takes a cut point nearer is none

struct Normal {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0;
};

CuttableLine Moved(const Rigid3& motion, const CuttableLine& line) {
  CuttableLine moved = line;
  moved.segment_in_cam = {motion * line.segment_in_cam.start, motion * line.segment_in_cam.end};
  const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
  moved.start_covariance = rotation * line.start_covariance * rotation.transpose();
  moved.end_covariance = rotation * line.end_covariance * rotation.transpose();
  return moved;
}

// Adds one line with its points as they were measured. False when one of them is too near.
bool AddMeasured(const RectifiedCamera& camera,
                 const WeightedCut& term,
                 const Rigid3& motion,
                 Normal& out) {
  const CuttableLine moved = Moved(motion, term.line);
  Eigen::Matrix<double, 2, 6> rows;
  Eigen::Vector2d r;
  for (int k = 0; k < 2; ++k) {
    const double ratio = k == 0 ? term.cut.first : term.cut.second;
    if (PointAt(moved.segment_in_cam, ratio).z() < kMinDepth) return false;
    const CutResidual residual = EvaluateCutPoint(camera, moved, ratio);
    rows.row(k) = residual.pose_row.transpose();
    r(k) = residual.r;
  }
  out.hessian += rows.transpose() * term.weight * rows;
  out.gradient += rows.transpose() * term.weight * r;
  out.cost += r.dot(term.weight * r);
  return true;
}

// Adds one line with its most likely points: X = X0 - Sigma g r / v, with r the residual at X0
// linearized at X and v = g^T Sigma g + sigma^2; the cost is then r^2 / v.
bool AddAdjusted(const RectifiedCamera& camera,
                 const WeightedCut& term,
                 const Rigid3& motion,
                 Normal& out) {
  const CuttableLine moved = Moved(motion, term.line);
  for (const double ratio : {term.cut.first, term.cut.second}) {
    const Eigen::Vector3d measured = PointAt(moved.segment_in_cam, ratio);
    const Eigen::Matrix3d covariance = InterpolatedCovariance(moved, ratio);
    CuttableLine point = moved;
    Eigen::Vector3d x = measured;
    CutResidual residual;
    double r = 0, variance = 1;
    for (int i = 0; i < kPointIterations; ++i) {
      if (x.z() < kMinDepth) return false;
      point.segment_in_cam = {x, x};
      residual = EvaluateCutPoint(camera, point, 0);
      const Eigen::Vector3d sigma_g = covariance * residual.gradient;
      r = residual.r + residual.gradient.dot(measured - x);
      variance = residual.gradient.dot(sigma_g) + moved.sigma_px * moved.sigma_px;
      x = measured - sigma_g * (r / variance);
    }
    out.hessian += residual.pose_row * residual.pose_row.transpose() / variance;
    out.gradient += residual.pose_row * (r / variance);
    out.cost += r * r / variance;
  }
  return true;
}

// Levenberg-Marquardt from no motion. `add` is one of the functions above.
template <class Add>
Rigid3 Minimize(std::span<const WeightedCut> lines, const Add& add) {
  const auto linearize = [&](const Rigid3& motion) {
    Normal normal;
    for (const WeightedCut& term : lines) {
      if (!term.cut.used || add(term, motion, normal)) continue;
      normal.cost = std::numeric_limits<double>::infinity();
      break;
    }
    return normal;
  };
  Rigid3 motion;
  Normal at = linearize(motion);
  double damping = 1e-6;
  for (int i = 0; i < kIterations; ++i) {
    Matrix6d damped = at.hessian;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * at.hessian.trace();
    const Rigid3 moved = RetractLeft(motion, -SolveSymmetric<6>(damped, at.gradient));
    const Normal next = linearize(moved);
    if (next.cost < at.cost) {
      const bool done = at.cost - next.cost < 1e-9 * at.cost;
      motion = moved;
      at = next;
      damping *= 0.1;
      if (done) break;
    } else {
      damping = damping < 1e-3 ? 1e-3 : 10 * damping;
      if (damping > 1e8) break;
    }
  }
  return motion;
}

}  // namespace

Rigid3 SolvePoseFromLines(const RectifiedCamera& camera, std::span<const WeightedCut> lines) {
  return Minimize(lines, [&](const WeightedCut& term, const Rigid3& motion, Normal& out) {
    return AddMeasured(camera, term, motion, out);
  });
}

Rigid3 SolvePoseAndPoints(const RectifiedCamera& camera, std::span<const WeightedCut> lines) {
  return Minimize(lines, [&](const WeightedCut& term, const Rigid3& motion, Normal& out) {
    return AddAdjusted(camera, term, motion, out);
  });
}

}  // namespace plumbline
