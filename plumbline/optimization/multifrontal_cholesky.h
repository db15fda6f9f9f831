// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Nonzero blocks of a symmetric matrix. Each row lists its columns left of the diagonal, ascending.
// The diagonal belongs to every pattern.
using BlockPattern = std::vector<std::vector<int>>;

// A step of a Cholesky factorization on a dense matrix. It eliminates some rows and updates the
// rows that are nonzero in their columns.
struct Front {
  std::vector<int> rows;  // in the order of elimination: the pivots, then the updated rows
  int pivots = 0;
  // The front that eliminates the first of the updated rows; -1 if it updates none.
  int parent = -1;
};

// A whole factorization. Children stand before their parents and close to them, so that few updates
// wait to be used.
struct EliminationPlan {
  std::vector<Front> fronts;
  // Multiplications of blocks, without those of the explicit zeros of merged fronts.
  double multiplications = 0;
};

// Plans a factorization in the approximate minimum degree order (Amestoy, Davis, Duff 1996, as in
// Eigen), which gives little fill-in. Keyframes where a path meets itself after a loop are
// eliminated last. Columns share a front if that saves work (Duff and Reid 1983). Depends on the
// pattern alone. When stopped, the plan is empty.
//
//   cost   about O(nonzero blocks of the factor)
EliminationPlan PlanElimination(const BlockPattern& pattern, const StopCheck& stop = {});

// Plans to eliminate all rows at once, in their order, as a dense factorization does.
EliminationPlan PlanInOneFront(int rows);

// Returns the number of rows of a full matrix whose factorization takes the same number of
// multiplications.
double FullSize(const EliminationPlan& plan);

// Multifrontal Cholesky factorization of a sparse symmetric positive definite matrix of square
// blocks. Each front is a dense matrix that adds the updates of its children, eliminates its pivots
// and passes on the rest (Duff and Reid 1983). It is serial and sums in the order of the plan, so
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
  // diagonal block only the lower triangle is read.
  void Set(int row, int column, const Block& block);
  // Factorizes the matrix in place. Returns false if it is not positive definite, or when stopped
  // (checked before each front). O(multiplications of the plan); memory: the factor, and pending
  // updates.
  bool Factor(const StopCheck& stop = {});
  // Solves L L^T x = b in place. O(entries of L).
  void Solve(Eigen::VectorXd& x) const;

 private:
  // Columns of the pivots in the dense matrix of a front. They become columns of L.
  struct Panel {
    Eigen::MatrixXd columns;
    std::vector<int> children;
    std::vector<int> in_parent;  // place of each updated row among the parent's rows
  };

  // Adds a child's update to the columns of a front, and to the update that the front passes on.
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
