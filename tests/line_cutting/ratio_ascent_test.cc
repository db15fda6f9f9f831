// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/ratio_ascent.h"

#include "plumbline/base/random.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

TEST(RatioAscent, FindsTheMaximumOfAnElongatedQuadratic) {
  const Vector2d best(0.3, 0.7);
  const auto objective = [&](const Vector2d& x, Vector2d& gradient) {
    const Vector2d d = x - best;
    Eigen::Matrix2d h;
    h << 100, 30, 30, 10;
    gradient = -2 * h * d;
    return -d.dot(h * d);
  };
  const RatioAscent<2> found = Ascend<2>(objective, Vector2d(0, 1));
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.ratios - best).norm(), 1e-3);
}

TEST(RatioAscent, StopsAtTheEdgeOfTheBox) {
  const auto objective = [](const Vector2d& x, Vector2d& gradient) {
    gradient = {3, -2 * (x.y() - 0.25)};
    return 3 * x.x() - (x.y() - 0.25) * (x.y() - 0.25);
  };
  const RatioAscent<2> found = Ascend<2>(objective, Vector2d(0.5, 1));
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.ratios.x(), 1);
  EXPECT_NEAR(found.ratios.y(), 0.25, 1e-4);
}

TEST(RatioAscent, StaysWhereNothingIsBetter) {
  const auto objective = [](const Vector2d& x, Vector2d& gradient) {
    gradient = {-1, 1};
    return x.y() - x.x();
  };
  const RatioAscent<2> found = Ascend<2>(objective, Vector2d(0, 1));
  EXPECT_EQ(found.iterations, 0);
  EXPECT_EQ(found.ratios, Vector2d(0, 1));
}

TEST(RatioAscent, NeverEndsLowerThanItBegan) {
  Rng rng(1);
  for (int trial = 0; trial < 100; ++trial) {
    VectorXd phase(10), start(10);
    for (int i = 0; i < 10; ++i) {
      phase(i) = rng.Uniform(0, 6);
      start(i) = rng.Uniform();
    }
    const auto objective = [&](const VectorXd& x, VectorXd& gradient) {
      gradient = 9 * (9 * x + phase).array().cos();
      return (9 * x + phase).array().sin().sum();
    };
    VectorXd gradient(10);
    const RatioAscent<Eigen::Dynamic> found = Ascend<Eigen::Dynamic>(objective, start);
    EXPECT_GE(found.value, objective(start, gradient));
    objective(found.ratios, gradient);
    const VectorXd free = (found.ratios + gradient).cwiseMax(0).cwiseMin(1) - found.ratios;
    EXPECT_LT(free.lpNorm<Eigen::Infinity>(), 1e-2);
  }
}

}  // namespace
}  // namespace plumbline
