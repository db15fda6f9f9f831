// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/grid_search.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

double Hill(const Vector2d& ratios, Vector2d&) {
  return -(ratios - Vector2d(0.2, 0.75)).squaredNorm();
}

TEST(GridSearch, FindsTheBestOfTheGrid) {
  const GridMaximum best = SearchGrid(Hill, 20);
  EXPECT_LT((best.ratios - Vector2d(0.2, 0.75)).norm(), 1e-12);
  EXPECT_NEAR(best.value, 0, 1e-12);
}

TEST(GridSearch, SurfaceHasTheSecondRatioUpwards) {
  const Eigen::MatrixXd surface = SurfaceOf(Hill, 4);
  ASSERT_EQ(surface.rows(), 5);
  Vector2d unused;
  EXPECT_DOUBLE_EQ(surface(3, 1), Hill({0.25, 0.75}, unused));
  EXPECT_DOUBLE_EQ(surface(1, 3), Hill({0.75, 0.25}, unused));
}

}  // namespace
}  // namespace plumbline
