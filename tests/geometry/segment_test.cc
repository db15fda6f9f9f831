// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/segment.h"

#include "plumbline/base/random.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
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

TEST(UndirectedAngle, InSpaceIgnoresWhereALineStarts) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d tilted(std::cos(0.1), 0, std::sin(0.1));
  EXPECT_NEAR(UndirectedAngle(x, tilted), 0.1, 1e-12);
  EXPECT_NEAR(UndirectedAngle(x, Eigen::Vector3d(-tilted)), 0.1, 1e-12);
  EXPECT_NEAR(UndirectedAngle(x, Eigen::Vector3d(5 * Eigen::Vector3d::UnitZ())),
              0.5 * std::numbers::pi,
              1e-12);
}

TEST(Distance, OfASegmentIsThatOfItsNearestPoint) {
  const Segment3 s{{0, 0, 0}, {2, 0, 0}};
  EXPECT_DOUBLE_EQ(Distance(s, {1, 3, 4}), 5);
  EXPECT_DOUBLE_EQ(Distance(s, {-3, 0, 4}), 5);
  EXPECT_DOUBLE_EQ(Distance(s, {5, 4, 0}), 5);
  EXPECT_DOUBLE_EQ(Distance(Segment3{s.start, s.start}, {3, 0, 4}), 5);
}

TEST(StretchWithin, IsWhatDenseSamplingFinds) {
  constexpr int kSteps = 2000;
  constexpr double kRadius = 0.3;
  Rng rng(5);
  int met = 0, missed = 0, inner = 0;
  for (int i = 0; i < 400; ++i) {
    const Segment3 axis{RandomVector<3>(rng, 0.5), RandomVector<3>(rng, 0.5)};
    const Segment3 segment{RandomVector<3>(rng, 0.5), RandomVector<3>(rng, 0.5)};
    const double step = segment.Length() / kSteps;
    std::optional<Stretch> sampled;
    for (int k = 0; k <= kSteps; ++k) {
      const Eigen::Vector3d point = segment.start + k * step * segment.Direction();
      if (Distance(axis, point) > kRadius) continue;
      if (!sampled) sampled = Stretch{k * step, k * step};
      sampled->to = k * step;
    }
    const std::optional<Stretch> exact = StretchWithin(segment, axis, kRadius);
    if (!sampled) {
      EXPECT_TRUE(!exact || exact->Length() <= step) << i;
      ++missed;
      continue;
    }
    ASSERT_TRUE(exact) << i;
    EXPECT_NEAR(exact->from, sampled->from, 1.001 * step) << i;
    EXPECT_NEAR(exact->to, sampled->to, 1.001 * step) << i;
    ++met;
    if (exact->from > 0 && exact->to < segment.Length()) ++inner;
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(missed, 100);
  EXPECT_GT(inner, 20);
}

TEST(StretchWithin, OfParallelSegmentsReachesBeyondTheEnds) {
  const Segment3 axis{{1, 0, 0}, {2, 0, 0}};
  const auto stretch = StretchWithin({{0, 0.3, 0}, {10, 0.3, 0}}, axis, 0.5);
  ASSERT_TRUE(stretch);
  EXPECT_NEAR(stretch->from, 0.6, 1e-12);
  EXPECT_NEAR(stretch->to, 2.4, 1e-12);
  EXPECT_FALSE(StretchWithin({{0, 0.6, 0}, {10, 0.6, 0}}, axis, 0.5));
  EXPECT_FALSE(StretchWithin({{3, 0, 0}, {10, 0, 0}}, axis, 0.5));
  // Almost parallel: nothing is divided by the tiny angle.
  const auto tilted = StretchWithin({{0, 0.3, 0}, {10, 0.3, 1e-15}}, axis, 0.5);
  ASSERT_TRUE(tilted);
  EXPECT_NEAR(tilted->from, 0.6, 1e-9);
  EXPECT_NEAR(tilted->to, 2.4, 1e-9);
}

TEST(StretchWithin, KnowsSegmentsOfNoLength) {
  const Segment3 point{{1, 0.3, 0}, {1, 0.3, 0}};
  const Segment3 axis{{0, 0, 0}, {2, 0, 0}};
  const auto of_point = StretchWithin(point, axis, 0.5);
  ASSERT_TRUE(of_point);
  EXPECT_EQ(of_point->Length(), 0);
  EXPECT_FALSE(StretchWithin(point, axis, 0.2));
  const auto of_ball = StretchWithin(axis, point, 0.5);
  ASSERT_TRUE(of_ball);
  EXPECT_NEAR(of_ball->from, 0.6, 1e-12);
  EXPECT_NEAR(of_ball->to, 1.4, 1e-12);
}

using Parts = std::vector<std::pair<double, double>>;

Parts Ends(const std::vector<Stretch>& parts) {
  Parts ends;
  for (const Stretch& part : parts) ends.emplace_back(part.from, part.to);
  return ends;
}

TEST(Stretches, AreJoinedWhereTheyOverlapOrTouch) {
  const std::vector<Stretch> stretches = {{4, 5}, {0, 1}, {1, 2}, {1.5, 3}};
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 1)), (Parts{{0, 3}, {4, 5}}));
  EXPECT_DOUBLE_EQ(TotalLength(CoveredAtLeast(stretches, 1)), 4);
  EXPECT_TRUE(CoveredAtLeast({}, 1).empty());
}

TEST(Stretches, AreCountedPlaceByPlace) {
  const std::vector<Stretch> stretches = {{0, 10}, {2, 6}, {4, 8}};
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 2)), (Parts{{2, 8}}));
  EXPECT_EQ(Ends(CoveredAtLeast(stretches, 3)), (Parts{{4, 6}}));
  EXPECT_TRUE(CoveredAtLeast(stretches, 4).empty());
}

TEST(Stretches, AreComparedWithWhatWasExpected) {
  const std::vector<Stretch> shown = {{0, 10}, {0, 4}};
  const std::vector<Stretch> expected = {{0, 10}, {0, 10}, {0, 10}};
  EXPECT_EQ(Ends(WellCovered(shown, expected, 1, 0.5)), (Parts{{0, 4}}));
  EXPECT_EQ(Ends(WellCovered(shown, expected, 1, 0.3)), (Parts{{0, 10}}));
  // Nothing is expected beyond 6.
  EXPECT_EQ(Ends(WellCovered(shown, std::vector<Stretch>{{0, 6}, {0, 6}, {0, 6}}, 1, 0.5)),
            (Parts{{0, 4}, {6, 10}}));
}

TEST(Stretches, AgreeWithCountingAtRandomPlaces) {
  Rng rng(1, "stretches");
  for (int trial = 0; trial < 50; ++trial) {
    const auto draw = [&] {
      std::vector<Stretch> stretches;
      for (int i = 0; i < 8; ++i) {
        const double from = rng.Uniform(0, 10);
        stretches.push_back({from, from + rng.Uniform(0, 5)});
      }
      return stretches;
    };
    const std::vector<Stretch> stretches = draw(), expected = draw();
    const std::vector<Stretch> parts = WellCovered(stretches, expected, 2, 0.6);
    for (int i = 0; i < 40; ++i) {
      const double place = rng.Uniform(0, 15);
      const auto count = [&](const std::vector<Stretch>& all) {
        return std::count_if(all.begin(), all.end(), [&](const Stretch& s) {
          return s.from <= place && place <= s.to;
        });
      };
      const bool well = count(stretches) >= 2 && static_cast<double>(count(stretches)) >=
                                                     0.6 * static_cast<double>(count(expected));
      EXPECT_EQ(count(parts), well ? 1 : 0) << place;
    }
  }
}

TEST(Stretches, LoseTheirGapsUpToALimit) {
  const std::vector<Stretch> parts = {{0, 1}, {1.5, 2}, {4, 5}};
  EXPECT_EQ(Ends(WithGapsClosed(parts, 0.5)), (Parts{{0, 2}, {4, 5}}));
  EXPECT_EQ(Ends(WithGapsClosed(parts, 0.4)), (Parts{{0, 1}, {1.5, 2}, {4, 5}}));
  EXPECT_EQ(Ends(WithGapsClosed(parts, 2)), (Parts{{0, 5}}));
}

}  // namespace

}  // namespace plumbline
