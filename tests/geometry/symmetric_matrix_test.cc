// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/symmetric_matrix.h"

#include "tests/support/random_geometry.h"
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

template <int N>
void CheckEigenpairs() {
  Rng rng(N);
  const Eigen::Matrix<double, N, N> matrix = RandomInformation<N>(rng);
  const Eigenpairs<N> pairs = EigenpairsOf<N>(matrix);
  EXPECT_TRUE(
      (pairs.vectors * pairs.values.asDiagonal() * pairs.vectors.transpose()).isApprox(matrix));
  EXPECT_TRUE((pairs.vectors.transpose() * pairs.vectors).isIdentity(1e-9));
  EXPECT_TRUE(EigenvaluesOf<N>(matrix).isApprox(pairs.values));
  for (int i = 1; i < N; ++i) EXPECT_LE(pairs.values(i - 1), pairs.values(i));
}

TEST(Eigenpairs, MakeUpTheMatrix) {
  CheckEigenpairs<2>();
  CheckEigenpairs<3>();
  CheckEigenpairs<4>();
  CheckEigenpairs<6>();
  CheckEigenpairs<9>();
}

template <int N>
void CheckSolution() {
  Rng rng(N);
  const Eigen::Matrix<double, N, N> matrix = RandomInformation<N>(rng);
  const Eigen::Matrix<double, N, 1> x = RandomVector<N>(rng);
  EXPECT_TRUE(SolveSymmetric<N>(matrix, matrix * x).isApprox(x, 1e-7));
  // What stands above the diagonal is not read.
  Eigen::Matrix<double, N, N> lower = matrix.template triangularView<Eigen::Lower>();
  EXPECT_EQ(SolveSymmetric<N>(lower, matrix * x), SolveSymmetric<N>(matrix, matrix * x));
}

TEST(SolveSymmetric, SolvesLinearEquations) {
  CheckSolution<3>();
  CheckSolution<4>();
  CheckSolution<5>();
  CheckSolution<6>();
}

template <int N>
void CheckInverse() {
  Rng rng(N);
  const Eigen::Matrix<double, N, N> information = RandomInformation<N>(rng);
  const auto inverse = InverseOfInformation<N>(information, 1e-15);
  ASSERT_TRUE(inverse);
  EXPECT_TRUE((*inverse * information).isIdentity(1e-7));
  EXPECT_FALSE(InverseOfInformation<N>(-information, 1e-15));
  Eigen::Matrix<double, N, N> singular = information;
  singular.row(N - 1).setZero();
  singular.col(N - 1).setZero();
  EXPECT_FALSE(InverseOfInformation<N>(singular, 1e-15));
  Eigen::Matrix<double, N, N> unequal = Eigen::Matrix<double, N, N>::Identity();
  unequal(0, 0) = 1e-8;
  EXPECT_TRUE(InverseOfInformation<N>(unequal, 1e-9));
  EXPECT_FALSE(InverseOfInformation<N>(unequal, 1e-7));
  unequal(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(InverseOfInformation<N>(unequal, 1e-15));
}

TEST(InverseOfInformation, IsThereWhereItIsPositiveDefinite) {
  CheckInverse<3>();
  CheckInverse<4>();
  CheckInverse<5>();
}

}  // namespace

}  // namespace plumbline
