// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/multifrontal_cholesky.h"

#include "plumbline/base/error.h"

#include "tests/optimization/block_patterns.h"
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {

namespace {

using testing::ManyPatterns;
using testing::PathPattern;

TEST(EliminationPlan, EliminatesEveryRowOnce) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    std::vector<int> eliminated(pattern.size(), 0);
    const EliminationPlan plan = PlanElimination(pattern);
    for (const Front& front : plan.fronts) {
      ASSERT_GT(front.pivots, 0);
      ASSERT_GE(static_cast<int>(front.rows.size()), front.pivots);
      for (int k = 0; k < front.pivots; ++k) {
        ++eliminated[static_cast<std::size_t>(front.rows[static_cast<std::size_t>(k)])];
      }
    }
    EXPECT_EQ(eliminated, std::vector<int>(pattern.size(), 1));
  }
}

TEST(EliminationPlan, ParentsComeLaterAndHaveAllThatTheirChildrenChange) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    const EliminationPlan plan = PlanElimination(pattern);
    for (std::size_t f = 0; f < plan.fronts.size(); ++f) {
      const Front& front = plan.fronts[f];
      const bool changes = static_cast<int>(front.rows.size()) > front.pivots;
      ASSERT_EQ(front.parent >= 0, changes);
      if (!changes) continue;
      ASSERT_GT(front.parent, static_cast<int>(f));
      const std::vector<int>& above = plan.fronts[static_cast<std::size_t>(front.parent)].rows;
      const std::set<int> known(above.begin(), above.end());
      for (std::size_t k = static_cast<std::size_t>(front.pivots); k < front.rows.size(); ++k) {
        EXPECT_TRUE(known.contains(front.rows[k]));
      }
    }
  }
}

TEST(EliminationPlan, HasEachBlockInTheFrontThatEliminatesIt) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    std::set<std::pair<int, int>> covered;
    for (const Front& front : PlanElimination(pattern).fronts) {
      for (int k = 0; k < front.pivots; ++k) {
        for (const int row : front.rows) {
          const int pivot = front.rows[static_cast<std::size_t>(k)];
          covered.insert({std::max(row, pivot), std::min(row, pivot)});
        }
      }
    }
    for (std::size_t row = 0; row < pattern.size(); ++row) {
      for (const int column : pattern[row]) {
        EXPECT_TRUE(covered.contains({static_cast<int>(row), column}));
      }
    }
  }
}

TEST(EliminationPlan, IsEmptyWhenItIsStopped) {
  const BlockPattern pattern = PathPattern(20, 3, 1000);
  int questions = 0;
  EXPECT_FALSE(PlanElimination(pattern, [&] { return ++questions < 0; }).fronts.empty());
  EXPECT_GT(questions, 20) << "before every column";
  for (int until = 0; until < questions; ++until) {
    int asked = 0;
    const EliminationPlan plan = PlanElimination(pattern, [&] { return asked++ >= until; });
    EXPECT_TRUE(plan.fronts.empty()) << until;
    EXPECT_LE(asked, until + 2);
  }
}

TEST(EliminationPlan, CountsOneFrontAsFull) {
  EXPECT_NEAR(FullSize(PlanElimination(PathPattern(100, 100, 1000))), 100, 0.01);
  EXPECT_NEAR(FullSize(PlanInOneFront(100)), 100, 0.01);
  EXPECT_EQ(FullSize(PlanElimination({})), 0);
  EXPECT_EQ(FullSize(PlanInOneFront(0)), 0);
  EXPECT_TRUE(PlanInOneFront(0).fronts.empty());
  std::vector<int> rows(5);
  std::iota(rows.begin(), rows.end(), 0);
  EXPECT_EQ(PlanInOneFront(5).fronts.at(0).rows, rows);
}

// A path that never comes back can be eliminated from its ends without anything new.
TEST(EliminationPlan, LosesNoZerosOfAPath) {
  constexpr int kRows = 400, kReach = 10;
  double least = 0;
  for (int row = 0; row < kRows; ++row) {
    const double below = std::min(kReach, kRows - 1 - row);
    least += below * (below + 1) / 2;
  }
  const EliminationPlan plan = PlanElimination(PathPattern(kRows, kReach, 100000));
  EXPECT_GE(plan.multiplications, least);
  EXPECT_LE(plan.multiplications, 2.5 * least);
}

// In the order of time a row of the last round would reach back to the first: 800 rows, nearly all
// of them full.
TEST(EliminationPlan, TakesLittleForPathsThatComeBack) {
  const EliminationPlan plan = PlanElimination(PathPattern(800, 3, 200));
  EXPECT_LT(FullSize(plan), 250);
  EXPECT_GT(plan.fronts.size(), 10U);
}

TEST(EliminationPlan, DependsOnThePatternAlone) {
  for (const BlockPattern& pattern : ManyPatterns()) {
    const EliminationPlan a = PlanElimination(pattern);
    const EliminationPlan b = PlanElimination(BlockPattern(pattern));
    ASSERT_EQ(a.fronts.size(), b.fronts.size());
    for (std::size_t f = 0; f < a.fronts.size(); ++f) {
      EXPECT_EQ(a.fronts[f].rows, b.fronts[f].rows);
      EXPECT_EQ(a.fronts[f].pivots, b.fronts[f].pivots);
      EXPECT_EQ(a.fronts[f].parent, b.fronts[f].parent);
    }
  }
}

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
