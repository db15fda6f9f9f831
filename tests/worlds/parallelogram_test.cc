// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/parallelogram.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Parallelogram, DistanceIsThatOfTheNearestOfItsPoints) {
  constexpr int kSteps = 120;
  Rng rng(3);
  int inside = 0;
  for (int i = 0; i < 60; ++i) {
    const Parallelogram shape{RandomVector<3>(rng), RandomVector<3>(rng), RandomVector<3>(rng)};
    const Eigen::Vector3d foot = shape.PointAt(rng.Uniform(-0.6, 1.6), rng.Uniform(-0.6, 1.6));
    const Eigen::Vector3d point = foot + RandomVector<3>(rng, 0.3);
    double sampled = std::numeric_limits<double>::infinity();
    bool inner = false;
    for (int a = 0; a <= kSteps; ++a) {
      for (int b = 0; b <= kSteps; ++b) {
        const double distance =
            (shape.PointAt(double(a) / kSteps, double(b) / kSteps) - point).norm();
        if (distance >= sampled) continue;
        sampled = distance;
        inner = a > 0 && a < kSteps && b > 0 && b < kSteps;
      }
    }
    const double cell = (shape.side_u.norm() + shape.side_v.norm()) / kSteps;
    const double exact = Distance(shape, point);
    EXPECT_LE(exact, sampled + 1e-12) << i;
    EXPECT_GE(exact, sampled - cell) << i;
    EXPECT_LE(shape.Bounds().exteriorDistance(point), exact + 1e-12) << i;
    if (inner) ++inside;
  }
  EXPECT_GT(inside, 5);
  EXPECT_LT(inside, 55);
}

TEST(Parallelogram, MayBeASegmentOrAPoint) {
  const Eigen::Vector3d side(2, 0, 0), none(0, 0, 0);
  EXPECT_DOUBLE_EQ(Distance({none, side, 0.5 * side}, {5, 4, 0}), std::sqrt(4 + 16.0));
  EXPECT_DOUBLE_EQ(Distance({none, none, none}, {3, 4, 0}), 5);
}

}  // namespace
}  // namespace plumbline
