// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/multifrontal_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The lower triangle of a symmetric matrix of 6 x 6 blocks. A small matrix is stored whole; of a
// large one, the diagonal blocks and those accessed by At.
class SymmetricBlocks {
 public:
  SymmetricBlocks(int rows, bool whole);

  bool whole() const { return whole_; }
  // Returns the number of stored blocks, including those on the diagonal.
  std::size_t count() const { return blocks_.size(); }
  // Sets all blocks to zero; they remain stored.
  void SetZero() { std::fill(blocks_.begin(), blocks_.end(), Matrix6d::Zero()); }

  // Returns the block at row >= column >= 0 for writing; zero at its first access. Valid until the
  // next call.
  Matrix6d& At(int row, int column) {
    Row& r = rows_[static_cast<std::size_t>(row)];
    if (column < r.first) Extend(column, r);
    int& place = r.places[static_cast<std::size_t>(column - r.first)];
    if (place < 0) place = Keep();
    return blocks_[static_cast<std::size_t>(place)];
  }
  const Matrix6d& Diagonal(int row) const {
    return blocks_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(row)].places.back())];
  }
  // Returns the block at row >= column; zero if it is not stored.
  Matrix6d Of(int row, int column) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    const int place = column < r.first ? -1 : r.places[static_cast<std::size_t>(column - r.first)];
    return place < 0 ? Matrix6d::Zero() : blocks_[static_cast<std::size_t>(place)];
  }
  // Returns true if the block at row >= column is one of the first `count` that were stored.
  bool IsAmongFirst(std::size_t count, int row, int column) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    if (column < r.first) return false;
    const int place = r.places[static_cast<std::size_t>(column - r.first)];
    return place >= 0 && static_cast<std::size_t>(place) < count;
  }

  // Calls visit(column, block) for the stored blocks of a row left of the diagonal, ordered by
  // column.
  template <class Visit>
  void ForEachLeft(int row, const Visit& visit) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    for (int column = r.first; column < row; ++column) {
      const int place = r.places[static_cast<std::size_t>(column - r.first)];
      if (place >= 0) visit(column, blocks_[static_cast<std::size_t>(place)]);
    }
  }
  BlockPattern Pattern() const;

  // A stored block left of the diagonal, and where it is stored; valid while count() is the same.
  struct Left {
    int row, column;
    std::size_t place;
  };
  std::vector<Left> AllLeft() const;
  const Matrix6d& At(const Left& left) const { return blocks_[left.place]; }

 private:
  struct Row {
    int first = 0;
    // Index in blocks_ of each column from `first` to the diagonal; -1 if not stored.
    std::vector<int> places;
  };

  int Keep();
  static void Extend(int column, Row& row);

  bool whole_;
  std::vector<Row> rows_;
  std::vector<Matrix6d> blocks_;
};

// Normal equations of one pose: sums of w J^T J (lower triangle valid) and w J^T r.
struct PoseEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

// Normal equations of one landmark with kDof parameters (V: lower triangle valid).
template <int kDof>
struct LandmarkEquations {
  Eigen::Matrix<double, kDof, kDof> V = Eigen::Matrix<double, kDof, kDof>::Zero();
  Eigen::Matrix<double, kDof, 1> g = Eigen::Matrix<double, kDof, 1>::Zero();
};

// Off-diagonal block w J_pose^T J_landmark between a landmark and one free pose.
template <int kDof, class Scalar = double>
struct Coupling {
  int pose = 0;  // index among the free poses
  Eigen::Matrix<Scalar, 6, kDof> W = Eigen::Matrix<Scalar, 6, kDof>::Zero();
};

// Targets to which an observation adds its part of the normal equations. `pose` and `W` are null
// for a fixed pose.
template <int kDof>
struct BaTarget {
  LandmarkEquations<kDof>& landmark;
  PoseEquations* pose;
  Eigen::Matrix<double, 6, kDof>* W;
};

// Adds w J^T J and w J^T r of an observation with two residuals r. c0 and c1 are the rows of the
// landmark's J; `pose_rows` returns those of the pose as a pair and is called only for a free pose.
template <int kDof, class PoseRows>
void AddTwoRows(double w,
                const Eigen::Vector2d& r,
                const Eigen::Matrix<double, kDof, 1>& c0,
                const Eigen::Matrix<double, kDof, 1>& c1,
                const BaTarget<kDof>& target,
                const PoseRows& pose_rows) {
  const Eigen::Matrix<double, kDof, 1> wc0 = w * c0;
  const Eigen::Matrix<double, kDof, 1> wc1 = w * c1;
  target.landmark.V.noalias() += wc0 * c0.transpose() + wc1 * c1.transpose();
  target.landmark.g += r(0) * wc0 + r(1) * wc1;
  if (target.pose == nullptr) return;
  const auto [a0, a1] = pose_rows();
  const Vector6d wa0 = w * a0;
  const Vector6d wa1 = w * a1;
  target.pose->H.noalias() += wa0 * a0.transpose() + wa1 * a1.transpose();
  target.pose->g += r(0) * wa0 + r(1) * wa1;
  target.W->noalias() += a0 * wc0.transpose() + a1 * wc1.transpose();
}

// A landmark after its elimination: with V + damping = L L^T, y = L^-1 g, and its couplings hold
// Z = W L^-T instead of W.
template <int kDof>
struct EliminatedLandmark {
  Eigen::Matrix<double, kDof, kDof> L = Eigen::Matrix<double, kDof, kDof>::Zero();
  Eigen::Matrix<double, kDof, 1> y = Eigen::Matrix<double, kDof, 1>::Zero();
  bool regular = false;  // false: the landmark does not move in this step

  // Sets L, y and `regular` from V + lambda diag(V) and g.
  bool Factor(const LandmarkEquations<kDof>& equations, double lambda);
  // Returns -L^-T (y + x).
  Eigen::Matrix<double, kDof, 1> Step(
      const Eigen::Matrix<double, kDof, 1>& x = Eigen::Matrix<double, kDof, 1>::Zero()) const;
};

// Damped Gauss-Newton equations of free poses and landmarks, with the landmarks eliminated one by
// one into a system of the poses (Schur complement):
//
//   (H - sum Z Z^T) step = -(g - sum Z y),   landmark step = -L^-T (y + sum Z^T step)
//
// Damping adds lambda times the diagonal (Marquardt), which makes a step independent of the units
// of the parameters. Sums run in the order of the calls, so results repeat bit by bit.
//
// Up to 200 free poses the system is solved as a dense one. Beyond that, only nonzero blocks are
// stored, and the poses are eliminated in an order with little fill-in (PlanElimination). Time and
// memory then grow linearly with the number of poses if these share landmarks with neighbours only,
// even for paths with revisits.
//
// A few landmarks that poses far apart share, e.g. long lines, may fill most of the factor. If
// there are any (LaterLandmarksMayTie) and that takes less than half of the time, the system is
// solved by preconditioned conjugate gradients, to a ten-thousandth of the decrease of the linear
// model. The preconditioner is the factor of the system without the blocks by which these landmarks
// couple groups of poses. A group shares earlier landmarks with its first pose. The preconditioner
// is positive definite whenever the system is.
class SchurSolver {
 public:
  explicit SchurSolver(int free_poses);

  // Clears the equations.
  void Reset();
  // Tells that landmarks eliminated from now on may be shared by poses that share none of those
  // eliminated before.
  void LaterLandmarksMayTie();
  PoseEquations& pose(int index) { return poses_[static_cast<std::size_t>(index)]; }
  // Adds a block w J_row^T J_column of an observation that depends on two free poses, row > column.
  void AddCoupling(int row, int column, const Matrix6d& block) {
    complement_.At(row, column) -= block;
  }

  // Eliminates one landmark. `couplings` must be ordered by pose, with each pose at most once; on
  // return they hold Z. O(couplings squared); allocates if, of more than 200 poses, two share a
  // landmark for the first time.
  template <int kDof>
  EliminatedLandmark<kDof> Eliminate(const LandmarkEquations<kDof>& landmark,
                                     double lambda,
                                     std::span<Coupling<kDof>> couplings);

  // Solves for the steps of the poses. Returns false if the damped system is not positive definite,
  // and when stopped.
  bool Solve(double lambda, const StopCheck& stop = {});
  // Returns true if the last solution was found by conjugate gradients.
  bool iterative() const { return iterative_; }
  Eigen::Ref<const Vector6d> step(int index) const { return step_.segment<6>(6 * index); }

  // Returns the step of an eliminated landmark after Solve(). The couplings may be kept in single
  // precision: an error of 1e-7 of a step does not change where the iterations end.
  template <int kDof, class Scalar>
  Eigen::Matrix<double, kDof, 1> LandmarkStep(
      const EliminatedLandmark<kDof>& landmark,
      std::span<const Coupling<kDof, Scalar>> couplings) const;

 private:
  // Adds Z Z^T by 2x2 blocks, to the lower triangle only, since nothing else is read.
  template <int kDof>
  static void AddToLower(const Eigen::Matrix<double, 6, kDof>& Z, Matrix6d& sum) {
    sum.leftCols<2>().noalias() += Z * Z.template topRows<2>().transpose();
    sum.template block<4, 2>(2, 2).noalias() +=
        Z.template bottomRows<4>() * Z.template middleRows<2>(2).transpose();
    sum.template block<2, 2>(4, 4).noalias() +=
        Z.template bottomRows<2>() * Z.template bottomRows<2>().transpose();
  }
  // Returns H + lambda diag(H) of a pose minus its part of the sum of Z Z^T; only the lower
  // triangle is valid.
  Matrix6d DiagonalBlock(std::size_t pose, double lambda) const;
  // Sets group_of_ to the groups of couplings whose poses share earlier landmarks with the first
  // pose of the group.
  template <int kDof>
  void FindGroups(std::span<Coupling<kDof>> couplings);
  // Plans the factorization, of the whole system or of the preconditioner. Returns false when
  // stopped.
  bool Plan(const StopCheck& stop);
  void Fill(double lambda);
  // Multiplies by the system of the poses.
  Eigen::VectorXd Product(const Eigen::VectorXd& x) const;
  // Replaces the right hand side in step_ by the solution. Returns false if the system is not
  // positive definite, and when stopped.
  bool SolveIteratively(const StopCheck& stop);

  std::vector<PoseEquations> poses_;
  SymmetricBlocks complement_;          // sum of Z Z^T; on the diagonal only the lower triangle
  SymmetricBlocks ties_;                // its part between groups, not in complement_
  std::vector<Vector6d> complement_g_;  // sum of Z y
  bool may_tie_ = false;                // true after LaterLandmarksMayTie
  std::size_t earlier_blocks_ = 0;      // blocks of complement_ at its first call
  std::vector<int> group_of_;           // group of each coupling of one landmark
  MultifrontalCholesky cholesky_;       // factorizes the system of the poses, or a preconditioner
  bool iterative_ = false;
  // Numbers of blocks of complement_ and ties_ for which cholesky_ was planned.
  std::size_t planned_blocks_ = 0, planned_ties_ = 0;
  std::vector<SymmetricBlocks::Left> left_, left_ties_;  // all blocks, for products
  std::vector<Matrix6d> diagonal_;                       // diagonal blocks of the system
  Eigen::VectorXd step_;
};

// Returns the work to solve by preconditioned conjugate gradients a system with so many blocks, as
// EliminationPlan::multiplications that take as long.
double IteratingWork(const EliminationPlan& preconditioner, std::size_t blocks);

template <int kDof>
bool EliminatedLandmark<kDof>::Factor(const LandmarkEquations<kDof>& equations, double lambda) {
  const auto& V = equations.V;
  const double floor = 1e-12 * V.diagonal().maxCoeff();
  regular = false;
  for (int j = 0; j < kDof; ++j) {
    const double damped = V(j, j) + lambda * (V(j, j) > floor ? V(j, j) : floor);
    double pivot = damped;
    double value = equations.g(j);
    for (int k = 0; k < j; ++k) {
      pivot -= L(j, k) * L(j, k);
      value -= L(j, k) * y(k);
    }
    if (!(pivot > 1e-14 * damped)) return false;
    L(j, j) = std::sqrt(pivot);
    const double inverse = 1 / L(j, j);
    y(j) = value * inverse;
    for (int i = j + 1; i < kDof; ++i) {
      double entry = V(i, j);
      for (int k = 0; k < j; ++k) entry -= L(i, k) * L(j, k);
      L(i, j) = entry * inverse;
    }
  }
  regular = true;
  return true;
}

template <int kDof>
Eigen::Matrix<double, kDof, 1> EliminatedLandmark<kDof>::Step(
    const Eigen::Matrix<double, kDof, 1>& x) const {
  Eigen::Matrix<double, kDof, 1> step = -(y + x);
  for (int j = kDof - 1; j >= 0; --j) {
    for (int k = j + 1; k < kDof; ++k) step(j) -= L(k, j) * step(k);
    step(j) /= L(j, j);
  }
  return step;
}

template <int kDof>
EliminatedLandmark<kDof> SchurSolver::Eliminate(const LandmarkEquations<kDof>& landmark,
                                                double lambda,
                                                std::span<Coupling<kDof>> couplings) {
  EliminatedLandmark<kDof> out;
  if (!out.Factor(landmark, lambda)) return out;
  for (Coupling<kDof>& coupling : couplings) {
    for (int j = 0; j < kDof; ++j) {
      for (int k = 0; k < j; ++k) coupling.W.col(j) -= out.L(j, k) * coupling.W.col(k);
      coupling.W.col(j) *= 1 / out.L(j, j);
    }
    complement_g_[static_cast<std::size_t>(coupling.pose)].noalias() += coupling.W * out.y;
  }
  if (may_tie_) FindGroups(couplings);
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      SymmetricBlocks& blocks = may_tie_ && group_of_[i] != group_of_[j] ? ties_ : complement_;
      blocks.At(couplings[i].pose, couplings[j].pose).noalias() +=
          couplings[i].W * couplings[j].W.transpose();
    }
    AddToLower(couplings[i].W, complement_.At(couplings[i].pose, couplings[i].pose));
  }
  return out;
}

template <int kDof>
void SchurSolver::FindGroups(std::span<Coupling<kDof>> couplings) {
  group_of_.resize(couplings.size());
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    std::size_t first = 0;  // the first coupling of a group
    while (first < i &&
           !(group_of_[first] == static_cast<int>(first) &&
             complement_.IsAmongFirst(earlier_blocks_, couplings[i].pose, couplings[first].pose))) {
      ++first;
    }
    group_of_[i] = static_cast<int>(first);
  }
}

template <int kDof, class Scalar>
Eigen::Matrix<double, kDof, 1> SchurSolver::LandmarkStep(
    const EliminatedLandmark<kDof>& landmark,
    std::span<const Coupling<kDof, Scalar>> couplings) const {
  Eigen::Matrix<double, kDof, 1> x = Eigen::Matrix<double, kDof, 1>::Zero();
  if (!landmark.regular) return x;
  for (const Coupling<kDof, Scalar>& coupling : couplings) {
    x.noalias() +=
        coupling.W.template cast<double>().transpose() * step_.segment<6>(6 * coupling.pose);
  }
  return landmark.Step(x);
}

}  // namespace plumbline
