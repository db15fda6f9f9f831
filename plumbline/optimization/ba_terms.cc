// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ba_terms.h"

#include "plumbline/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace plumbline {

namespace {

// Returns [p]x M for column-major M.
inline Eigen::Matrix3d CrossColumns(const Eigen::Vector3d& p, const Eigen::Matrix3d& M) {
  Eigen::Matrix3d out;
  out.row(0) = p.y() * M.row(2) - p.z() * M.row(1);
  out.row(1) = p.z() * M.row(0) - p.x() * M.row(2);
  out.row(2) = p.x() * M.row(1) - p.y() * M.row(0);
  return out;
}

}  // namespace

bool BaPoint::Add(const RectifiedCamera& camera,
                  const BaPose& pose,
                  const View& view,
                  const Term& term,
                  double huber,
                  const Target& target) {
  const Eigen::Vector3d p = pose.ToCamera(view);
  PointLinearization a;
  if (!LinearizePoint(camera, term, p, a)) return false;
  const double w = HuberWeight(a.r.squaredNorm(), huber);
  // The rows are J_cam [-[p]x, I] for the pose and J_cam R for the point: with M = w J_cam^T J_cam
  // all blocks are products of M, [p]x and R.
  const double wux = w * a.ux;
  const double wvy = w * a.vy;
  Eigen::Matrix3d M;
  M << wux * a.ux, 0, wux * a.uz, 0, wvy * a.vy, wvy * a.vz, wux * a.uz, wvy * a.vz,
      w * (a.uz * a.uz + a.vz * a.vz + a.dz * a.dz);
  const Eigen::Vector3d q(
      wux * a.r.x(), wvy * a.r.y(), w * (a.uz * a.r.x() + a.vz * a.r.y() + a.dz * a.r.z()));
  Eigen::Matrix3d N;  // M R, without the products by zero
  N.row(0) = M(0, 0) * pose.R.row(0) + M(0, 2) * pose.R.row(2);
  N.row(1) = M(1, 1) * pose.R.row(1) + M(1, 2) * pose.R.row(2);
  N.row(2) = M(0, 2) * pose.R.row(0) + M(1, 2) * pose.R.row(1) + M(2, 2) * pose.R.row(2);
  target.landmark.V.noalias() += pose.R.transpose() * N;
  target.landmark.g.noalias() += pose.R.transpose() * q;
  if (target.pose == nullptr) return true;
  const Eigen::Matrix3d PM = CrossColumns(p, M);
  // The block is symmetric.
  target.pose->H.topLeftCorner<3, 3>() += CrossColumns(p, PM.transpose());
  target.pose->H.bottomLeftCorner<3, 3>() += PM.transpose();
  target.pose->H.bottomRightCorner<3, 3>() += M;
  target.pose->g.head<3>() += p.cross(q);
  target.pose->g.tail<3>() += q;
  target.W->topRows<3>() += CrossColumns(p, N);
  target.W->bottomRows<3>() += N;
  return true;
}

double BaMeasuredLine::Chi2(const RectifiedCamera& camera,
                            const BaPose& pose,
                            const Place& line,
                            const Term& term) {
  Eigen::Vector2d r;
  const BaLineInCamera seen(pose, line, term.shift);
  if (!WhitenedLineDistances(camera, term, seen.moment, r)) {
    return std::numeric_limits<double>::infinity();
  }
  return r.squaredNorm();
}

bool BaLine::Add(const RectifiedCamera& camera,
                 const BaPose& pose,
                 const View& view,
                 const Term& term,
                 double huber,
                 const Target& target) {
  return AddMeasuredLine<kDof>(camera, pose, view, term, huber, target);
}

namespace {

double Chi2(const Eigen::Matrix3d& axis_from_world,
            double weight,
            const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = axis_from_world * direction;
  return weight * weight * d.head<2>().squaredNorm() / d.squaredNorm();
}

}  // namespace

BaParallelLines::BaParallelLines(const BaProblem& problem) {
  if (problem.parallel_lines.empty()) return;
  auto sorted = problem.parallel_lines;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::tie(a.line, a.axis) < std::tie(b.line, b.axis);
  });
  begin_.assign(problem.lines.size() + 1, 0);
  for (const auto& parallel : sorted) {
    ++begin_[static_cast<std::size_t>(parallel.line) + 1];
    const Eigen::Vector3d& axis = problem.axes[static_cast<std::size_t>(parallel.axis)];
    const Eigen::Quaterniond turn = ShortestTurn(axis, Eigen::Vector3d::UnitZ());
    residuals_.push_back({turn.toRotationMatrix(), 1 / parallel.sigma});
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
}

double BaParallelLines::Loss(std::size_t line,
                             const Eigen::Vector3d& direction,
                             double huber) const {
  double sum = 0;
  if (residuals_.empty()) return sum;
  for (std::size_t k = begin_[line]; k < begin_[line + 1]; ++k) {
    const Residual& residual = residuals_[k];
    if (!residual.used) continue;
    sum += HuberLoss(Chi2(residual.axis_from_world, residual.weight, direction), huber);
  }
  return sum;
}

void BaParallelLines::UpdateChi2(std::size_t line, const Eigen::Vector3d& direction) {
  if (residuals_.empty()) return;
  for (std::size_t k = begin_[line]; k < begin_[line + 1]; ++k) {
    residuals_[k].chi2 = Chi2(residuals_[k].axis_from_world, residuals_[k].weight, direction);
  }
}

bool BaParallelLines::Classify() {
  bool changed = false;
  for (Residual& residual : residuals_) {
    const bool used = residual.chi2 <= Chi2Limit95(2);
    changed |= used != residual.used;
    residual.used = used;
  }
  return changed;
}

void BaParallelLines::UseAll() {
  for (Residual& residual : residuals_) residual.used = std::isfinite(residual.chi2);
}

std::size_t BaParallelLines::used() const {
  return static_cast<std::size_t>(std::count_if(
      residuals_.begin(), residuals_.end(), [](const Residual& r) { return r.used; }));
}

std::size_t BaParallelLines::Bytes() const {
  return begin_.capacity() * sizeof(std::size_t) + residuals_.capacity() * sizeof(Residual);
}

}  // namespace plumbline
