// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>
#include <iterator>
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

std::vector<SymmetricBlocks::Left> SymmetricBlocks::AllLeft() const {
  std::vector<Left> all;
  all.reserve(blocks_.size() - rows_.size());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const Row& r = rows_[row];
    for (std::size_t k = 0; k + 1 < r.places.size(); ++k) {
      if (r.places[k] < 0) continue;
      all.push_back({static_cast<int>(row),
                     r.first + static_cast<int>(k),
                     static_cast<std::size_t>(r.places[k])});
    }
  }
  return all;
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

// Returns the blocks that one of two patterns has.
BlockPattern Joined(BlockPattern a, const BlockPattern& b) {
  for (std::size_t row = 0; row < a.size(); ++row) {
    std::vector<int> both;
    std::set_union(
        a[row].begin(), a[row].end(), b[row].begin(), b[row].end(), std::back_inserter(both));
    a[row] = std::move(both);
  }
  return a;
}

}  // namespace

double IteratingWork(const EliminationPlan& preconditioner, std::size_t blocks) {
  constexpr double kIterations = 40;
  // Time of the product of a block and a vector, in times of a multiplication of two blocks in a
  // front. Each block is multiplied twice.
  constexpr double kProduct = 0.5;
  double in_factor = 0;
  for (const Front& front : preconditioner.fronts) {
    in_factor += static_cast<double>(front.pivots) * static_cast<double>(front.rows.size());
  }
  return preconditioner.multiplications +
         2 * kIterations * kProduct * (in_factor + static_cast<double>(blocks));
}

SchurSolver::SchurSolver(int free_poses)
    : poses_(static_cast<std::size_t>(free_poses)),
      complement_(free_poses, free_poses <= kDensePoses),
      ties_(complement_.whole() ? 0 : free_poses, false),
      complement_g_(poses_.size()),
      cholesky_(complement_.whole() ? PlanInOneFront(free_poses) : EliminationPlan{}),
      planned_blocks_(complement_.whole() ? complement_.count() : 0),
      step_(6 * free_poses) {
  Reset();
}

void SchurSolver::Reset() {
  std::fill(poses_.begin(), poses_.end(), PoseEquations{});
  complement_.SetZero();
  ties_.SetZero();
  may_tie_ = false;
  std::fill(complement_g_.begin(), complement_g_.end(), Vector6d::Zero());
}

void SchurSolver::LaterLandmarksMayTie() {
  if (complement_.whole()) return;
  if (earlier_blocks_ == 0) earlier_blocks_ = complement_.count();
  // Poses that hardly share any would be groups of their own.
  may_tie_ = earlier_blocks_ >= 2 * poses_.size();
}

bool SchurSolver::Plan(const StopCheck& stop) {
  const BlockPattern grouped = complement_.Pattern();
  EliminationPlan whole = PlanElimination(Joined(grouped, ties_.Pattern()), stop);
  if (IsToStop(stop)) return false;
  EliminationPlan preconditioner;
  iterative_ = false;
  if (ties_.count() > poses_.size()) {
    preconditioner = PlanElimination(grouped, stop);
    if (IsToStop(stop)) return false;
    const std::size_t blocks = complement_.count() + ties_.count();
    iterative_ = 2 * IteratingWork(preconditioner, blocks) < whole.multiplications;
  }
  cholesky_ = MultifrontalCholesky(std::move(iterative_ ? preconditioner : whole));
  planned_blocks_ = complement_.count();
  planned_ties_ = ties_.count();
  if (iterative_) {
    left_ = complement_.AllLeft();
    left_ties_ = ties_.AllLeft();
  }
  return true;
}

bool SchurSolver::Solve(double lambda, const StopCheck& stop) {
  const bool planned = planned_blocks_ == complement_.count() &&
                       (complement_.whole() || planned_ties_ == ties_.count());
  if (!planned && !Plan(stop)) return false;
  Fill(lambda);
  if (!cholesky_.Factor(stop)) return false;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    step_.segment<6>(6 * static_cast<Eigen::Index>(i)) = complement_g_[i] - poses_[i].g;
  }
  if (!iterative_) {
    cholesky_.Solve(step_);
  } else if (!SolveIteratively(stop)) {
    return false;
  }
  return step_.allFinite();
}

Eigen::VectorXd SchurSolver::Product(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    const auto at = 6 * static_cast<Eigen::Index>(i);
    y.segment<6>(at).noalias() = diagonal_[i] * x.segment<6>(at);
  }
  const auto subtract = [&](const SymmetricBlocks& blocks,
                            const std::vector<SymmetricBlocks::Left>& all) {
    for (const SymmetricBlocks::Left& left : all) {
      const Matrix6d& block = blocks.At(left);
      y.segment<6>(6 * left.row).noalias() -= block * x.segment<6>(6 * left.column);
      y.segment<6>(6 * left.column).noalias() -= block.transpose() * x.segment<6>(6 * left.row);
    }
  };
  subtract(complement_, left_);
  subtract(ties_, left_ties_);
  return y;
}

bool SchurSolver::SolveIteratively(const StopCheck& stop) {
  constexpr std::size_t kMostIterations = 200, kLast = 5;
  // The iterations end when the last ones have lowered the cost of the linear model by no more than
  // this share of what all of them have. The next linearization finds the rest.
  constexpr double kTolerance = 1e-4;
  Eigen::VectorXd residual = step_;
  step_.setZero();
  Eigen::VectorXd preconditioned = residual;
  cholesky_.Solve(preconditioned);
  Eigen::VectorXd direction = preconditioned;
  double size = residual.dot(preconditioned);
  std::vector<double> lowered(1, 0);  // by all iterations so far
  while (size > 0 && lowered.size() <= kMostIterations) {
    if (IsToStop(stop)) return false;
    const Eigen::VectorXd product = Product(direction);
    const double curvature = direction.dot(product);
    if (!(curvature > 0)) return false;
    const double length = size / curvature;
    step_ += length * direction;
    residual -= length * product;
    lowered.push_back(lowered.back() + 0.5 * length * size);
    if (lowered.size() > kLast &&
        lowered.back() - lowered[lowered.size() - 1 - kLast] <= kTolerance * lowered.back()) {
      break;
    }
    preconditioned = residual;
    cholesky_.Solve(preconditioned);
    const double next = residual.dot(preconditioned);
    direction = preconditioned + next / size * direction;
    size = next;
  }
  return true;
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
  diagonal_.resize(iterative_ ? poses_.size() : 0);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const int row = static_cast<int>(i);
    complement_.ForEachLeft(
        row, [&](int column, const Matrix6d& block) { cholesky_.Set(row, column, -block); });
    const Matrix6d diagonal = DiagonalBlock(i, lambda);
    cholesky_.Set(row, row, diagonal);
    if (iterative_) {
      diagonal_[i] = diagonal.selfadjointView<Eigen::Lower>();
    } else if (!complement_.whole()) {
      ties_.ForEachLeft(row, [&](int column, const Matrix6d& block) {
        cholesky_.Set(row, column, -block - complement_.Of(row, column));
      });
    }
  }
}

}  // namespace plumbline
