// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/segment.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Segment, KnowsItsLengthDirectionAndMiddle) {
  const Segment2 s{{1, 2}, {4, 6}};
  EXPECT_DOUBLE_EQ(s.Length(), 5);
  EXPECT_LT((s.Direction() - Eigen::Vector2d(0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(s.Midpoint(), Eigen::Vector2d(2.5, 4));
  EXPECT_EQ(s.Reversed().start, s.end);
  EXPECT_EQ(s.Reversed().end, s.start);
}

TEST(LineThrough, HoldsBothEndsAndIsScaledToDistances) {
  Rng rng(1);
  for (int i = 0; i < 30; ++i) {
    const Segment2 s{RandomVector<2>(rng, 300), RandomVector<2>(rng, 300)};
    const Eigen::Vector3d l = LineThrough(s);
    EXPECT_NEAR(l.head<2>().norm(), 1, 1e-15);
    EXPECT_NEAR(LineDistance(l, s.start), 0, 1e-11);
    EXPECT_NEAR(LineDistance(l, s.end), 0, 1e-11);
    const Eigen::Vector2d off = s.Midpoint() + 3 * l.head<2>();
    EXPECT_NEAR(LineDistance(l, off), 3, 1e-11);
  }
}

TEST(LineThrough, NormalIsTheDirectionTurnedFromXTowardsY) {
  // x right, y down: +90 degrees takes right (1, 0) to down (0, 1).
  const Eigen::Vector3d right = LineThrough({{0, 5}, {10, 5}});
  EXPECT_LT((right - Eigen::Vector3d(0, 1, -5)).norm(), 1e-14);
  EXPECT_GT(LineDistance(right, {0, 6}), 0);
  const Eigen::Vector3d down = LineThrough({{5, 0}, {5, 10}});
  EXPECT_LT((down - Eigen::Vector3d(-1, 0, 5)).norm(), 1e-14);
  EXPECT_LT((LineThrough({{5, 10}, {5, 0}}) + down).norm(), 1e-14);
}

TEST(UndirectedAngle, IgnoresTheSenseOfBoth) {
  const Eigen::Vector2d a(1, 0);
  const Eigen::Vector2d b(std::cos(0.4), std::sin(0.4));
  EXPECT_NEAR(UndirectedAngle(a, b), 0.4, 1e-15);
  EXPECT_NEAR(UndirectedAngle(a, -3 * b), 0.4, 1e-15);
  EXPECT_NEAR(UndirectedAngle(-a, b), 0.4, 1e-15);
  EXPECT_NEAR(UndirectedAngle(a, {0, -2}), std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(UndirectedAngle(a, -a), 0);
}

TEST(OverlapRatio, IsTheShareOfTheShorter) {
  const Segment2 reference{{0, 0}, {10, 0}};
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, reference), 1);
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{2, 3}, {6, -1}}), 1);    // within
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{6, -1}, {2, 3}}), 1);    // reversed
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{8, 0}, {12, 0}}), 0.5);  // half out
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{-5, 0}, {20, 0}}), 1);   // covers
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{5, 0}, {25, 0}}), 0.5);  // the reference is shorter
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{11, 0}, {15, 0}}), 0);   // beyond
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{-9, 0}, {-1, 0}}), 0);   // before
  EXPECT_DOUBLE_EQ(OverlapRatio(reference, {{5, 0}, {5, 9}}), 0);     // upright
}

}  // namespace
}  // namespace plumbline
