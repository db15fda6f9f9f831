// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/symmetric_rank_update.h"

#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index columns) {
  Rng rng(3, "rank_update");
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return rng.Normal(1); });
}

// Subtracts by plain loops, in the order that the function promises.
void SubtractPlainly(const Eigen::MatrixXd& A, Eigen::MatrixXd& C) {
  constexpr Eigen::Index kAtOnce = 256;
  for (Eigen::Index first = 0; first < A.cols(); first += kAtOnce) {
    for (Eigen::Index j = 0; j < C.cols(); ++j) {
      for (Eigen::Index i = j; i < C.rows(); ++i) {
        double sum = 0;
        for (Eigen::Index k = first; k < std::min(first + kAtOnce, A.cols()); ++k) {
          sum += A(i, k) * A(j, k);
        }
        C(i, j) -= sum;
      }
    }
  }
}

// Sizes around those of tiles and blocks.
constexpr std::array<std::pair<int, int>, 8> kSizes = {
    {{1, 1}, {4, 6}, {6, 6}, {17, 12}, {30, 256}, {66, 257}, {126, 66}, {300, 18}}};

TEST(SubtractSquare, GivesTheBitsOfPlainLoops) {
  for (const auto& [rows, columns] : kSizes) {
    const Eigen::MatrixXd A = RandomMatrix(rows + 12, columns);
    Eigen::MatrixXd expected = RandomMatrix(rows, rows);
    Eigen::MatrixXd C = expected;
    SubtractPlainly(A.bottomRows(rows), expected);
    SubtractSquare(A.bottomRows(rows), C);
    EXPECT_TRUE(C == expected) << rows << " x " << columns;
  }
}

TEST(SubtractSquare, AgreesWithEigen) {
  for (const auto& [rows, columns] : kSizes) {
    const Eigen::MatrixXd A = RandomMatrix(rows, columns);
    Eigen::MatrixXd expected = RandomMatrix(rows, rows);
    Eigen::MatrixXd C = expected;
    expected.selfadjointView<Eigen::Lower>().rankUpdate(A, -1);
    SubtractSquare(A, C);
    EXPECT_LT((C - expected).cwiseAbs().maxCoeff(), 1e-13 * columns) << rows << " x " << columns;
  }
}

TEST(SubtractSquare, LeavesWhatNothingIsSubtractedFrom) {
  Eigen::MatrixXd empty;
  SubtractSquare(Eigen::MatrixXd(0, 6), empty);
  Eigen::MatrixXd C = RandomMatrix(5, 5);
  const Eigen::MatrixXd before = C;
  SubtractSquare(Eigen::MatrixXd(5, 0), C);
  EXPECT_EQ(C, before);
}

}  // namespace
}  // namespace plumbline
