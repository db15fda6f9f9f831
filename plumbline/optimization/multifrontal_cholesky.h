// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/elimination_plan.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Cholesky factorization of a sparse symmetric positive definite matrix of square blocks, front by
// front. Each front is a dense matrix that takes in what its children change, eliminates its pivots
// and hands on the rest (Duff and Reid 1983). It is serial and sums in the order of the plan, so
// that results repeat bit by bit.
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
  // Sets block (row, column) and with it its mirror image. Both rows must be in one front. Of a
  // block on the diagonal only the lower triangle is looked at.
  void Set(int row, int column, const Block& block);
  // Factorizes the matrix in place. Returns false where it is not positive definite, or when
  // stopped (asked before each front). O(multiplications of the plan); memory: the factor, and the
  // changes that wait to be handed on.
  bool Factor(const StopCheck& stop = {});
  // Solves L L^T x = b in place. O(entries of L).
  void Solve(Eigen::VectorXd& x) const;

 private:
  // The columns of the pivots in the dense matrix of a front. They become columns of L.
  struct Panel {
    Eigen::MatrixXd columns;
    std::vector<int> children;
    std::vector<int> in_parent;  // place of each changed row among the parent's rows
  };

  // Adds what a child changed to the columns of a front, and to the changes that the front hands
  // on.
  static void TakeIn(const Eigen::MatrixXd& change,
                     const std::vector<int>& place,
                     Eigen::MatrixXd& columns,
                     Eigen::MatrixXd& own_change);

  std::vector<Front> fronts_;
  std::vector<Panel> panels_;  // one panel for each front
  std::vector<int> front_of_;  // the front that eliminates each row
  std::vector<int> pivot_of_;  // place of each row among the pivots of its front
};

extern template class BlockCholesky<6>;
extern template class BlockCholesky<7>;

using MultifrontalCholesky = BlockCholesky<6>;

}  // namespace plumbline
