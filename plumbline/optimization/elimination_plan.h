// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <vector>

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

}  // namespace plumbline
