// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Some rows of a symmetric matrix, its lower triangle, from the first column on in which one of
// them is not zero.
struct EnvelopePanel {
  Eigen::Index begin = 0;  // first row
  Eigen::Index first = 0;  // first column: where a panel begins, this one at the latest
  Eigen::MatrixXd rows;    // columns first to begin + rows; above the diagonal not looked at
};

// Cholesky factorization of a symmetric positive definite matrix within its envelope: what lies to
// the left of a panel's first column is zero and remains zero, whatever comes after. Of the
// equations of a camera path, ordered by time, that is most of the matrix. All is done by dense
// operations on panels; a single panel is a dense factorization.
//
//   panels   by row, all of them; replaced by the rows of L
//   stop     asked before each product of two panels
//   returns  false where the matrix is not positive definite, and when stopped
//   cost     O(size width^2) for panels of that width, at most that of a dense factorization
bool FactorEnvelope(std::vector<EnvelopePanel>& panels, const StopCheck& stop = {});

// The size of the full matrix whose factorization takes as long as one within the envelope in which
// row i begins at column first[i] <= i. At most the number of rows. O(entries of the envelope).
double EnvelopeSize(std::span<const int> first);

// Solves L L^T x = b in place, L as FactorEnvelope leaves it. O(entries).
void SolveEnvelope(const std::vector<EnvelopePanel>& panels, Eigen::VectorXd& x);

}  // namespace plumbline
