// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>
#include <utility>

namespace plumbline {

SymmetricBlocks::SymmetricBlocks(int rows, bool whole)
    : whole_(whole), rows_(static_cast<std::size_t>(rows)) {
  if (whole) blocks_.reserve(rows_.size() * (rows_.size() + 1) / 2);
  for (int row = 0; row < rows; ++row) {
    Row& r = rows_[static_cast<std::size_t>(row)];
    r.first = whole ? 0 : row;
    for (int column = r.first; column <= row; ++column) r.places.push_back(Keep());
  }
}

BlockPattern SymmetricBlocks::Pattern() const {
  BlockPattern pattern(rows_.size());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    ForEachLeft(static_cast<int>(row),
                [&](int column, const Matrix6d& /*block*/) { pattern[row].push_back(column); });
  }
  return pattern;
}

int SymmetricBlocks::Keep() {
  blocks_.push_back(Matrix6d::Zero());
  return static_cast<int>(blocks_.size()) - 1;
}

// Makes room for a column left of the first one. Room is made for several columns, since they are
// often asked for one after the other, to the left.
void SymmetricBlocks::Extend(int column, Row& row) {
  constexpr int kStep = 32;
  const int first = column / kStep * kStep;
  row.places.insert(row.places.begin(), static_cast<std::size_t>(row.first - first), -1);
  row.first = first;
}

namespace {

// Up to this number of poses a dense factorization takes no longer than a sparse one.
constexpr int kDensePoses = 200;

}  // namespace

SchurSolver::SchurSolver(int free_poses)
    : poses_(static_cast<std::size_t>(free_poses)),
      complement_(free_poses, free_poses <= kDensePoses),
      complement_g_(poses_.size()),
      cholesky_(complement_.whole() ? PlanInOneFront(free_poses) : EliminationPlan{}),
      planned_blocks_(complement_.whole() ? complement_.count() : 0),
      step_(6 * free_poses) {
  Reset();
}

void SchurSolver::Reset() {
  std::fill(poses_.begin(), poses_.end(), PoseEquations{});
  complement_.SetZero();
  std::fill(complement_g_.begin(), complement_g_.end(), Vector6d::Zero());
}

bool SchurSolver::Solve(double lambda, const StopCheck& stop) {
  if (planned_blocks_ != complement_.count()) {
    EliminationPlan plan = PlanElimination(complement_.Pattern(), stop);
    if (IsToStop(stop)) return false;
    planned_blocks_ = complement_.count();
    cholesky_ = MultifrontalCholesky(std::move(plan));
  }
  Fill(lambda);
  if (!cholesky_.Factor(stop)) return false;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    step_.segment<6>(6 * static_cast<Eigen::Index>(i)) = complement_g_[i] - poses_[i].g;
  }
  cholesky_.Solve(step_);
  return step_.allFinite();
}

Matrix6d SchurSolver::DiagonalBlock(std::size_t pose, double lambda) const {
  const Matrix6d& H = poses_[pose].H;
  Matrix6d block = H - complement_.Diagonal(static_cast<int>(pose));
  // A pose without observations keeps a regular block, and its step is zero.
  const double floor = std::max(1e-12 * H.diagonal().maxCoeff(), 1e-30);
  block.diagonal() += lambda * H.diagonal().cwiseMax(floor);
  return block;
}

void SchurSolver::Fill(double lambda) {
  cholesky_.Clear();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const int row = static_cast<int>(i);
    complement_.ForEachLeft(
        row, [&](int column, const Matrix6d& block) { cholesky_.Set(row, column, -block); });
    cholesky_.Set(row, row, DiagonalBlock(i, lambda));
  }
}

}  // namespace plumbline
