// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/eigenpairs.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Its eigenvalues are far apart.
template <int N>
Eigen::Matrix<double, N, N> RandomSymmetric(Rng& rng) {
  Eigen::Matrix<double, N, N> root;
  for (int i = 0; i < N; ++i) root.col(i) = (i + 1) * RandomVector<N>(rng);
  return root * root.transpose();
}

template <int N>
void CheckEigenpairs() {
  Rng rng(N);
  const Eigen::Matrix<double, N, N> matrix = RandomSymmetric<N>(rng);
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
