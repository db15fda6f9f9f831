// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/eigenpairs.h"

#include "tests/support/random_geometry.h"

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

}  // namespace
}  // namespace plumbline
