// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>

namespace plumbline {
namespace {

// Of these a dense factorization takes no longer.
constexpr std::size_t kDensePoses = 200;
// Of more, in one panel: some that share landmarks with much the same others.
constexpr std::size_t kPanelPoses = 32;

}  // namespace

SchurSolver::SchurSolver(int free_poses)
    : poses_(static_cast<std::size_t>(free_poses)),
      complement_(poses_.size()),
      complement_g_(poses_.size()),
      panel_poses_(poses_.size() > kDensePoses ? kPanelPoses : kDensePoses),
      step_(6 * free_poses) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    complement_[i].first = PanelBegin(i);
    complement_[i].blocks.resize(i + 1 - complement_[i].first);
  }
  Reset();
}

void SchurSolver::Reset() {
  std::fill(poses_.begin(), poses_.end(), PoseEquations{});
  for (BlockRow& row : complement_) {
    std::fill(row.blocks.begin(), row.blocks.end(), Matrix6d::Zero());
  }
  std::fill(complement_g_.begin(), complement_g_.end(), Vector6d::Zero());
}

void SchurSolver::Extend(std::size_t column, BlockRow& row) const {
  const std::size_t first = PanelBegin(column);
  row.blocks.insert(row.blocks.begin(), row.first - first, Matrix6d::Zero());
  row.first = first;
}

bool SchurSolver::Solve(double lambda, const StopCheck& stop) {
  FillPanels(lambda);
  if (!FactorEnvelope(panels_, stop)) return false;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    step_.segment<6>(6 * static_cast<Eigen::Index>(i)) = complement_g_[i] - poses_[i].g;
  }
  SolveEnvelope(panels_, step_);
  return step_.allFinite();
}

Matrix6d SchurSolver::DiagonalBlock(std::size_t pose, double lambda) const {
  const Matrix6d& H = poses_[pose].H;
  Matrix6d block = H - complement_[pose].blocks.back();
  // A pose without observations keeps a regular block and gets the step zero.
  const double floor = std::max(1e-12 * H.diagonal().maxCoeff(), 1e-30);
  block.diagonal() += lambda * H.diagonal().cwiseMax(floor);
  return block;
}

void SchurSolver::FillPanels(double lambda) {
  const auto scalars = [](std::size_t poses) { return 6 * static_cast<Eigen::Index>(poses); };
  panels_.resize((poses_.size() + panel_poses_ - 1) / panel_poses_);
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const std::size_t begin = p * panel_poses_;
    const std::size_t end = std::min(begin + panel_poses_, poses_.size());
    std::size_t first = begin;
    for (std::size_t i = begin; i < end; ++i) first = std::min(first, complement_[i].first);
    EnvelopePanel& panel = panels_[p];
    panel.begin = scalars(begin);
    panel.first = scalars(first);
    panel.rows.setZero(scalars(end - begin), scalars(end - first));
    for (std::size_t i = begin; i < end; ++i) {
      const BlockRow& row = complement_[i];
      for (std::size_t k = 0; k + 1 < row.blocks.size(); ++k) {
        panel.rows.block<6, 6>(scalars(i - begin), scalars(row.first + k - first)) = -row.blocks[k];
      }
      panel.rows.block<6, 6>(scalars(i - begin), scalars(i - first)) = DiagonalBlock(i, lambda);
    }
  }
}

}  // namespace plumbline
