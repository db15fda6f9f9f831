// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <vector>

namespace plumbline {

// The blocks of a symmetric matrix that are not zero. Each row lists its columns left of the
// diagonal, ascending. The diagonal belongs to every pattern.
using BlockPattern = std::vector<std::vector<int>>;

// A step of a Cholesky factorization, carried out on a dense matrix. It eliminates some rows and
// changes the rows that are not zero in the columns of these.
struct Front {
  std::vector<int> rows;  // in the order of elimination: the pivots, then the rows that are changed
  int pivots = 0;
  // The front that eliminates the first of the changed rows; -1 where no rows are changed.
  int parent = -1;
};

// A whole factorization. Children stand before their parents and close to them, so that few results
// wait to be used.
struct EliminationPlan {
  std::vector<Front> fronts;
  // Multiplications of blocks, without those of the zeros that make fronts larger.
  double multiplications = 0;
};

// Plans a factorization in the approximate minimum degree order (Amestoy, Davis, Duff 1996, as in
// Eigen), in which few of the zeros are lost. Where keyframes of a path meet again after a loop,
// those places are eliminated last. Columns share a front where that saves work (Duff and Reid
// 1983). Depends on the pattern alone. When stopped, the plan is empty.
//
//   cost   about O(blocks of the factor that are not zero)
EliminationPlan PlanElimination(const BlockPattern& pattern, const StopCheck& stop = {});

// Plans to eliminate all rows at once, in their order, as a dense factorization does.
EliminationPlan PlanInOneFront(int rows);

// Returns the number of rows of a full matrix whose factorization takes as many multiplications.
double FullSize(const EliminationPlan& plan);

}  // namespace plumbline
