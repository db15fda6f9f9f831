// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/multifrontal_cholesky.h"

#include "plumbline/base/error.h"

#include "tests/optimization/block_patterns.h"
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ManyPatterns;

// A random positive definite matrix with a pattern. The diagonal outweighs the rest.
Eigen::MatrixXd RandomMatrix(const BlockPattern& pattern, unsigned seed) {
  testing::Random random(seed);
  const auto uniform = [&random]() { return random.Uniform(-1, 1); };
  const auto size = 6 * static_cast<Eigen::Index>(pattern.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](Eigen::Index row, Eigen::Index column) {
    Eigen::Matrix<double, 12, 12> A = Eigen::MatrixXd::NullaryExpr(12, 12, uniform);
    A = (A * A.transpose()).eval();
    matrix.block<6, 6>(6 * row, 6 * row) += A.topLeftCorner<6, 6>();
    matrix.block<6, 6>(6 * column, 6 * column) += A.bottomRightCorner<6, 6>();
    if (row == column) return;
    matrix.block<6, 6>(6 * row, 6 * column) += A.topRightCorner<6, 6>();
    matrix.block<6, 6>(6 * column, 6 * row) += A.bottomLeftCorner<6, 6>();
  };
  for (std::size_t row = 0; row < pattern.size(); ++row) {
    add(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(row));
    for (const int column : pattern[row]) add(static_cast<Eigen::Index>(row), column);
  }
  matrix.diagonal().array() += 0.01;
  return matrix;
}

// Above the diagonal stands what is not to be used.
void Load(const BlockPattern& pattern, const Eigen::MatrixXd& matrix, MultifrontalCholesky& out) {
  out.Clear();
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const int row = static_cast<int>(i);
    Matrix6d diagonal = matrix.block<6, 6>(6 * row, 6 * row);
    diagonal.triangularView<Eigen::StrictlyUpper>().setConstant(99);
    out.Set(row, row, diagonal);
    for (const int column : pattern[i]) {
      // Either of the two mirror images will do.
      if (column % 2 == 0) {
        out.Set(row, column, matrix.block<6, 6>(6 * row, 6 * column));
      } else {
        out.Set(column, row, matrix.block<6, 6>(6 * column, 6 * row));
      }
    }
  }
}

TEST(MultifrontalCholesky, SolvesAsADenseFactorizationDoes) {
  unsigned seed = 1;
  for (const BlockPattern& pattern : ManyPatterns()) {
    for (const EliminationPlan& plan :
         {PlanElimination(pattern), PlanInOneFront(static_cast<int>(pattern.size()))}) {
      MultifrontalCholesky cholesky(plan);
      for (int repetition = 0; repetition < 2; ++repetition) {  // with other numbers
        const Eigen::MatrixXd matrix = RandomMatrix(pattern, ++seed);
        const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(matrix.rows(), -1, 2);
        const Eigen::VectorXd expected = matrix.llt().solve(b);
        Load(pattern, matrix, cholesky);
        ASSERT_TRUE(cholesky.Factor());
        Eigen::VectorXd x = b;
        cholesky.Solve(x);
        EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << seed;
      }
    }
  }
}

TEST(MultifrontalCholesky, GivesTheSameBytesEveryTime) {
  const BlockPattern pattern = testing::PathPattern(60, 2, 20);
  const Eigen::MatrixXd matrix = RandomMatrix(pattern, 4);
  std::vector<Eigen::VectorXd> solutions;
  MultifrontalCholesky first(PlanElimination(pattern)), second(PlanElimination(pattern));
  for (MultifrontalCholesky* cholesky : {&first, &first, &second}) {
    Load(pattern, matrix, *cholesky);
    ASSERT_TRUE(cholesky->Factor());
    solutions.push_back(Eigen::VectorXd::Ones(matrix.rows()));
    cholesky->Solve(solutions.back());
  }
  EXPECT_EQ(solutions[0], solutions[1]);
  EXPECT_EQ(solutions[0], solutions[2]);
}

TEST(MultifrontalCholesky, RefusesWhatIsNotPositiveDefinite) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    for (const std::size_t bad : {std::size_t{0}, pattern.size() / 2, pattern.size() - 1}) {
      Eigen::MatrixXd matrix = RandomMatrix(pattern, 9);
      matrix.diagonal()(6 * static_cast<Eigen::Index>(bad) + 3) = -1;
      MultifrontalCholesky cholesky(PlanElimination(pattern));
      Load(pattern, matrix, cholesky);
      EXPECT_FALSE(cholesky.Factor());
    }
  }
}

// Two rows that always move together leave their difference open.
TEST(MultifrontalCholesky, RefusesASingularMatrix) {
  const BlockPattern pattern{{}, {0}};
  MultifrontalCholesky cholesky(PlanElimination(pattern));
  cholesky.Set(0, 0, Matrix6d::Identity());
  cholesky.Set(1, 0, Matrix6d::Identity());
  cholesky.Set(1, 1, Matrix6d::Identity());
  EXPECT_FALSE(cholesky.Factor());
}

TEST(MultifrontalCholesky, HasNoPlaceForBlocksOutsideThePattern) {
  const BlockPattern pattern{{}, {0}, {1}, {2}, {3}, {4}, {5}, {6}, {7}, {8}, {9}, {10}, {11}};
  EliminationPlan plan = PlanElimination(pattern);
  // Fronts of one row each, so that none has more than two rows.
  plan.fronts.clear();
  for (int row = 0; row < 13; ++row) {
    plan.fronts.push_back({{row}, 1, row < 12 ? row + 1 : -1});
    if (row < 12) plan.fronts.back().rows.push_back(row + 1);
  }
  MultifrontalCholesky cholesky(plan);
  cholesky.Set(5, 4, Matrix6d::Zero());
  EXPECT_THROW(cholesky.Set(6, 4, Matrix6d::Zero()), BugError);
}

TEST(MultifrontalCholesky, HasNothingToDoWithoutRows) {
  MultifrontalCholesky cholesky(PlanElimination({}));
  Eigen::VectorXd x(0);
  EXPECT_TRUE(cholesky.Factor());
  cholesky.Solve(x);
}

}  // namespace
}  // namespace plumbline
