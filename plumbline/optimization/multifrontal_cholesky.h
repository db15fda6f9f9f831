// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/elimination_plan.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Cholesky factorization of a sparse symmetric positive definite matrix of square blocks, front by
// front: each is a dense matrix that takes in what its children change, eliminates its pivots and
// hands on the rest (Duff and Reid 1983). Serial, sums in the order of the plan: results repeat bit
// by bit.
//
//   kSize  rows of a block; there are instances for 6 (rigid motions) and 7 (similarities)
template <int kSize>
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, kSize, kSize>;

  // Every row of the matrix is a pivot of one front.
  explicit BlockCholesky(EliminationPlan plan);

  // Makes the matrix zero.
  void Clear();
  // Sets block (row, column) and with it its mirror image; both must be in a front together. Of
  // those with row = column only the lower triangle is looked at.
  void Set(int row, int column, const Block& block);
  // False where the matrix is not positive definite, and when stopped (asked before each front).
  // Afterwards there is its factor in its place.
  // O(multiplications of the plan); memory: the factor, and what waits to be handed on.
  bool Factor(const StopCheck& stop = {});
  // Solves L L^T x = b in place. O(entries of L).
  void Solve(Eigen::VectorXd& x) const;

 private:
  // The columns of the pivots in the dense matrix of a front, which become those of L.
  struct Panel {
    Eigen::MatrixXd columns;
    std::vector<int> children;
    std::vector<int> in_parent;  // place of each row that is changed among the parent's
  };

  // Adds what a child changed to the columns of a front and to what it changes itself.
  static void TakeIn(const Eigen::MatrixXd& change,
                     const std::vector<int>& place,
                     Eigen::MatrixXd& columns,
                     Eigen::MatrixXd& own_change);

  std::vector<Front> fronts_;
  std::vector<Panel> panels_;  // by front
  std::vector<int> front_of_;  // by row: where it is eliminated
  std::vector<int> pivot_of_;  // by row: its place there
};

extern template class BlockCholesky<6>;
extern template class BlockCholesky<7>;

using MultifrontalCholesky = BlockCholesky<6>;

}  // namespace plumbline
