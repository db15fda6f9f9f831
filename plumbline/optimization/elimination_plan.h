// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace plumbline {

// The blocks of a symmetric matrix that are not zero: by row the columns left of the diagonal,
// ascending. The diagonal belongs to every pattern.
using BlockPattern = std::vector<std::vector<int>>;

// A step of a Cholesky factorization, carried out on a dense matrix: it eliminates some rows and
// changes those that are not zero in their columns.
struct Front {
  std::vector<int> rows;  // in the order of elimination: the pivots, then those that are changed
  int pivots = 0;
  int parent = -1;  // the front that eliminates the first of those changed; -1: there are none
};

// A whole factorization. Children stand before their parents, and close to them, so that little
// waits to be used.
struct EliminationPlan {
  std::vector<Front> fronts;
  double multiplications = 0;  // of blocks, without those of zeros that make fronts larger
};

// The approximate minimum degree order (Amestoy, Davis, Duff 1996, as in Eigen), in which few of
// the zeros are lost: where keyframes of a path meet again after a loop, those places are
// eliminated last. Fronts are as large as pays (Duff and Reid 1983). Depends on the pattern alone.
//
//   cost   about O(blocks of the factor that are not zero)
EliminationPlan PlanElimination(const BlockPattern& pattern);

// All rows at once, in their order: what a dense factorization does.
EliminationPlan PlanInOneFront(int rows);

// The number of rows of the full matrix whose factorization takes as many multiplications.
double FullSize(const EliminationPlan& plan);

}  // namespace plumbline
