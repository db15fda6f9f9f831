// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace plumbline {

SchurSolver::SchurSolver(int free_poses)
    : free_poses_(free_poses),
      poses_(static_cast<std::size_t>(free_poses)),
      complement_(poses_.size() * (poses_.size() + 1) / 2),
      complement_g_(static_cast<std::size_t>(free_poses)),
      matrix_(6 * free_poses, 6 * free_poses),
      step_(6 * free_poses) {
  Reset();
}

void SchurSolver::Reset() {
  std::fill(poses_.begin(), poses_.end(), PoseEquations{});
  std::fill(complement_.begin(), complement_.end(), Matrix6d::Zero());
  std::fill(complement_g_.begin(), complement_g_.end(), Vector6d::Zero());
}

bool SchurSolver::Solve(double lambda) {
  for (int i = 0; i < free_poses_; ++i) {
    const PoseEquations& pose = poses_[static_cast<std::size_t>(i)];
    for (int j = 0; j < i; ++j) matrix_.block<6, 6>(6 * i, 6 * j) = -Block(i, j);
    matrix_.block<6, 6>(6 * i, 6 * i) = pose.H - Block(i, i);
    // A pose without observations keeps a regular block and gets the step zero.
    const double floor = std::max(1e-12 * pose.H.diagonal().maxCoeff(), 1e-30);
    matrix_.diagonal().segment<6>(6 * i) += lambda * pose.H.diagonal().cwiseMax(floor);
    step_.segment<6>(6 * i) = complement_g_[static_cast<std::size_t>(i)] - pose.g;
  }
  if (free_poses_ == 0) return true;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> llt(matrix_);
  if (llt.info() != Eigen::Success) return false;
  llt.solveInPlace(step_);
  return step_.allFinite();
}

}  // namespace plumbline
