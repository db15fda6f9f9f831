// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/cutting_testbed/pose_from_lines.h"

#include "plumbline/cutting/cut_residuals.h"

#include <limits>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr int kIterations = 50;
constexpr double kMinDepth = 0.05;  // m; a step that takes a cut point nearer is none

struct Normal {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0;
};

Normal Linearize(const RectifiedCamera& camera,
                 std::span<const WeightedCut> lines,
                 const Rigid3& motion) {
  Normal out;
  for (const WeightedCut& term : lines) {
    if (!term.cut.used) continue;
    CuttableLine moved = term.line;
    moved.segment_in_cam = {motion * term.line.segment_in_cam.start,
                            motion * term.line.segment_in_cam.end};
    Eigen::Matrix<double, 2, 6> rows;
    Eigen::Vector2d r;
    for (int k = 0; k < 2; ++k) {
      const double ratio = k == 0 ? term.cut.first : term.cut.second;
      if (PointAt(moved.segment_in_cam, ratio).z() < kMinDepth) {
        out.cost = std::numeric_limits<double>::infinity();
        return out;
      }
      const CutResidual residual = EvaluateCutPoint(camera, moved, ratio);
      rows.row(k) = residual.pose_row.transpose();
      r(k) = residual.r;
    }
    out.hessian += rows.transpose() * term.weight * rows;
    out.gradient += rows.transpose() * term.weight * r;
    out.cost += r.dot(term.weight * r);
  }
  return out;
}

}  // namespace

Rigid3 SolvePoseFromLines(const RectifiedCamera& camera, std::span<const WeightedCut> lines) {
  Rigid3 motion;
  Normal at = Linearize(camera, lines, motion);
  double damping = 1e-6;
  for (int i = 0; i < kIterations; ++i) {
    Matrix6d damped = at.hessian;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * at.hessian.trace();
    const Vector6d step = -damped.ldlt().solve(at.gradient);
    const Rigid3 moved = RetractLeft(motion, step);
    const Normal next = Linearize(camera, lines, moved);
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

}  // namespace plumbline
