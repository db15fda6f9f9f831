// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/epipolar_cost.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/epipolar.h"

#include "tests/solvers/two_view_scene.h"
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::MakeTwoViewScene;
using testing::TwoViewScene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Over the variance of a coordinate, what the textbook has for matrices of any kind.
TEST(SampsonChi2, IsTheSquaredSampsonDistanceOverTheVariance) {
  const TwoViewScene scene = MakeTwoViewScene(1, {.points = 20, .outliers = 0.5, .sigma = 0.01});
  const Eigen::Matrix3d E = EssentialMatrix(scene.b_from_a);
  for (const RayMatch& m : scene.matches) {
    const Eigen::Vector3d in_b = E * m.a.homogeneous();
    const Eigen::Vector3d in_a = E.transpose() * m.b.homogeneous();
    const double error = m.b.homogeneous().dot(in_b);
    const double gradient = in_b.head<2>().squaredNorm() + in_a.head<2>().squaredNorm();
    EXPECT_NEAR(SampsonChi2(E, m), error * error / gradient / 1e-4, 1e-6);
  }
}

// 95 % of the inliers are within the gate (errata E1); with unequal deviations, too.
TEST(SampsonChi2, IsChiSquareWithOneDegree) {
  TwoViewScene scene = MakeTwoViewScene(2, {.points = 4000});
  Rng rng(9);
  for (RayMatch& m : scene.matches) {
    m.b += RandomVector<2>(rng, 0.003);
    m.sigma_b = std::hypot(m.sigma_b, 0.003);
  }
  const EpipolarCost cost(scene.matches);
  const Eigen::Matrix3d E = EssentialMatrix(scene.b_from_a);
  EXPECT_NEAR(cost.CountBelow(E, kChi2OneDof95) / 4000.0, 0.95, 0.012);
}

TEST(EpipolarCost, AgreesWithTheSingleDistancesForAnyNumber) {
  for (const int count : {0, 1, 7, 8, 9, 100}) {
    const TwoViewScene scene = MakeTwoViewScene(3, {.points = count, .outliers = 0.3});
    const Eigen::Matrix3d E = 0.3 * EssentialMatrix(scene.b_from_a);
    double sum = 0;
    int below = 0;
    for (const RayMatch& m : scene.matches) {
      sum += std::min(SampsonChi2(E, m), 4.0);
      below += SampsonChi2(E, m) < 4 ? 1 : 0;
    }
    const EpipolarCost cost(scene.matches);
    EXPECT_NEAR(cost.Truncated(E, 4, kInfinity), sum, 1e-9);
    EXPECT_EQ(cost.CountBelow(E, 4), below);
    EXPECT_GT(cost.Truncated(E, 4, 0.5 * sum), 0.5 * sum - 1e-12);
  }
}

}  // namespace
}  // namespace plumbline
