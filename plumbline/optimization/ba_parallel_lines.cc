// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ba_parallel_lines.h"

#include "plumbline/base/chi2.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace plumbline {
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
