// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>
#include <numeric>

namespace plumbline {
namespace {

// Of these a dense factorization takes no longer.
constexpr std::size_t kDensePoses = 200;
// Of more, in one panel: some that share landmarks with much the same others.
constexpr std::size_t kPanelPoses = 32;

}  // namespace

BlockRow::BlockRow(int row, bool full) : full_(full) {
  if (!full) return;
  columns_.resize(static_cast<std::size_t>(row) + 1);
  std::iota(columns_.begin(), columns_.end(), 0);
  blocks_.resize(columns_.size());
}

Matrix6d& BlockRow::At(int column) {
  if (full_) return blocks_[static_cast<std::size_t>(column)];
  const auto place = std::lower_bound(columns_.begin(), columns_.end(), column);
  const auto index = place - columns_.begin();
  if (place == columns_.end() || *place != column) {
    columns_.insert(place, column);
    blocks_.insert(blocks_.begin() + index, Matrix6d::Zero());
  }
  return blocks_[static_cast<std::size_t>(index)];
}

void BlockRow::SetZero() { std::fill(blocks_.begin(), blocks_.end(), Matrix6d::Zero()); }

SchurSolver::SchurSolver(int free_poses)
    : poses_(static_cast<std::size_t>(free_poses)),
      complement_g_(poses_.size()),
      panel_poses_(poses_.size() > kDensePoses ? kPanelPoses : kDensePoses),
      step_(6 * free_poses) {
  complement_.reserve(poses_.size());
  for (int i = 0; i < free_poses; ++i) complement_.emplace_back(i, poses_.size() <= kDensePoses);
  Reset();
}

void SchurSolver::Reset() {
  std::fill(poses_.begin(), poses_.end(), PoseEquations{});
  for (BlockRow& row : complement_) row.SetZero();
  std::fill(complement_g_.begin(), complement_g_.end(), Vector6d::Zero());
}

bool SchurSolver::Solve(double lambda) {
  FillPanels(lambda);
  if (!FactorEnvelope(panels_)) return false;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    step_.segment<6>(6 * static_cast<Eigen::Index>(i)) = complement_g_[i] - poses_[i].g;
  }
  SolveEnvelope(panels_, step_);
  return step_.allFinite();
}

Matrix6d SchurSolver::DiagonalBlock(std::size_t pose, double lambda) const {
  const Matrix6d& H = poses_[pose].H;
  const BlockRow& row = complement_[pose];
  const bool coupled = !row.columns().empty() && row.columns().back() == static_cast<int>(pose);
  Matrix6d block = coupled ? Matrix6d(H - row.blocks().back()) : H;
  // A pose without observations keeps a regular block and gets the step zero.
  const double floor = std::max(1e-12 * H.diagonal().maxCoeff(), 1e-30);
  block.diagonal() += lambda * H.diagonal().cwiseMax(floor);
  return block;
}

// The first panel that one of a panel's poses shares a landmark with.
std::size_t SchurSolver::FirstPanel(std::size_t begin, std::size_t end) const {
  std::size_t first = begin;
  for (std::size_t i = begin; i < end; ++i) {
    const std::vector<int>& columns = complement_[i].columns();
    if (!columns.empty()) first = std::min(first, static_cast<std::size_t>(columns.front()));
  }
  return first / panel_poses_ * panel_poses_;
}

void SchurSolver::FillPanels(double lambda) {
  const auto scalars = [](std::size_t poses) { return 6 * static_cast<Eigen::Index>(poses); };
  panels_.resize((poses_.size() + panel_poses_ - 1) / panel_poses_);
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const std::size_t begin = p * panel_poses_;
    const std::size_t end = std::min(begin + panel_poses_, poses_.size());
    const std::size_t first = FirstPanel(begin, end);
    EnvelopePanel& panel = panels_[p];
    panel.begin = scalars(begin);
    panel.first = scalars(first);
    panel.rows.setZero(scalars(end - begin), scalars(end - first));
    for (std::size_t i = begin; i < end; ++i) {
      const BlockRow& row = complement_[i];
      for (std::size_t k = 0; k < row.blocks().size(); ++k) {
        const auto column = static_cast<std::size_t>(row.columns()[k]);
        panel.rows.block<6, 6>(scalars(i - begin), scalars(column - first)) = -row.blocks()[k];
      }
      panel.rows.block<6, 6>(scalars(i - begin), scalars(i - first)) = DiagonalBlock(i, lambda);
    }
  }
}

}  // namespace plumbline
