// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/matching.h"

#include "plumbline/base/random.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace matching_test {

struct Score {
  double precision = 0;  // right / matched
  double recall = 0;     // right / seen in both
};

template <class Match>
Score ScoreOf(const std::vector<Match>& matches,
              const std::vector<std::size_t>& truth_a,
              const std::vector<std::size_t>& truth_b) {
  double right = 0;
  for (const Match& match : matches) {
    right +=
        truth_a[static_cast<std::size_t>(match.a)] == truth_b[static_cast<std::size_t>(match.b)];
  }
  double common = 0;
  for (const std::size_t landmark : truth_a) {
    common += static_cast<double>(std::count(truth_b.begin(), truth_b.end(), landmark));
  }
  return {right / static_cast<double>(matches.size()), right / common};
}

class ReferenceMatching : public ::testing::Test {
 protected:
  SyntheticFrame SenseAt(const Rigid3& pose) { return Sense(world_, pose, sensor_, rng_); }

  SyntheticWorld world_ = MakeSyntheticWorld(600, 60);
  SensorModel sensor_{.depth = false, .flipped_bits = 25};
  Rng rng_{3, "reference_matching"};
};

TEST_F(ReferenceMatching, FindsPointsAndLinesOfASlowMotion) {
  const SyntheticFrame a = SenseAt(PoseOnPath(0));
  const SyntheticFrame b = SenseAt(PoseOnPath(5));
  const auto matches = MatchToReference(a.indexed->features, b.indexed->features);
  const Score points = ScoreOf(matches.points, a.point_truth, b.point_truth);
  EXPECT_GT(points.precision, 0.99);
  EXPECT_GT(points.recall, 0.9);
  const Score lines = ScoreOf(matches.lines, a.line_truth, b.line_truth);
  EXPECT_GT(lines.precision, 0.95);
  EXPECT_GT(lines.recall, 0.8);
}

// Everything moves by more than the first window between the first frame and the last.
TEST_F(ReferenceMatching, FollowsAFastTurnFromFrameToFrame) {
  const auto pose = [](int frame) {
    return Rigid3{ExpSo3({0, -0.05 * frame, 0}), {-0.02 * frame, 0, 0}};
  };
  const SyntheticFrame a = SenseAt(pose(0));
  ImageMotion motion;
  ReferenceMatches matches;
  SyntheticFrame b;
  for (int frame = 1; frame <= 8; ++frame) {
    b = SenseAt(pose(frame));
    matches = MatchToReference(a.indexed->features, b.indexed->features, motion);
    motion = matches.motion;
  }
  const Score points = ScoreOf(matches.points, a.point_truth, b.point_truth);
  EXPECT_GT(points.precision, 0.99);
  EXPECT_GT(points.recall, 0.85);
  const auto without = MatchToReference(a.indexed->features, b.indexed->features);
  EXPECT_LT(without.points.size(), matches.points.size() / 4);
}

TEST_F(ReferenceMatching, OrientationThatDoesNotGoWithTheRollIsRejected) {
  const SyntheticFrame a = SenseAt(PoseOnPath(0));
  const SyntheticFrame b = SenseAt(PoseOnPath(3));
  Features turned = b.indexed->features;
  for (std::size_t i = 0; i < turned.points.size(); ++i) {
    turned.points[i].angle = i % 5 == 0 ? 1.5F : 0.4F;  // the camera rolled by 0.4
  }
  const auto matches = MatchToReference(a.indexed->features, turned);
  EXPECT_GT(matches.points.size(), 100U);
  for (const FeatureMatch& match : matches.points) EXPECT_NE(match.b % 5, 0);
}

TEST_F(ReferenceMatching, NothingInCommonGivesNothing) {
  const SyntheticFrame a = SenseAt(PoseOnPath(0));
  const Features empty;
  EXPECT_TRUE(MatchToReference(a.indexed->features, empty).points.empty());
  EXPECT_TRUE(MatchToReference(empty, a.indexed->features).lines.empty());
  EXPECT_FALSE(MatchToReference(empty, empty).motion.known());
}

Eigen::Vector2d RandomPixel(Rng& rng) {
  const double x = rng.Uniform(0, 640);
  return {x, rng.Uniform(0, 480)};
}

Eigen::Vector2d TurnedAndShifted(const Eigen::Vector2d& px) {
  const double angle = 0.2;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return 1.1 * turn * (px - Eigen::Vector2d(320, 240)) + Eigen::Vector2d(360, 215);
}

TEST(ImageMotion, DefaultMovesNothing) {
  const ImageMotion motion;
  EXPECT_FALSE(motion.known());
  EXPECT_EQ(motion(Eigen::Vector2d(3, 4)), Eigen::Vector2d(3, 4));
}

TEST(ImageMotion, OnePairShiftsEverything) {
  const std::vector<PixelPair> pairs{{{10, 10}, {15, 7}}};
  const ImageMotion motion(pairs);
  EXPECT_TRUE(motion.known());
  EXPECT_LT((motion(Eigen::Vector2d(100, 200)) - Eigen::Vector2d(105, 197)).norm(), 1e-9);
}

TEST(ImageMotion, AffineMapIsFoundAmongWrongMatches) {
  Rng rng(1);
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d from = RandomPixel(rng);
    const bool wrong = i % 4 == 0;
    pairs.push_back({from, wrong ? RandomPixel(rng) : TurnedAndShifted(from)});
  }
  const ImageMotion motion(pairs);
  int right = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d px = RandomPixel(rng);
    right += (motion(px) - TurnedAndShifted(px)).norm() < 2 ? 1 : 0;
  }
  EXPECT_GE(right, 93);  // elsewhere most neighbours are wrong
}

TEST(ImageMotion, NearThingsMoveAsTheirNeighbours) {
  Rng rng(1);
  const auto moved = [](const Eigen::Vector2d& px) {  // a near object on the left
    return Eigen::Vector2d(px.x() + (px.x() < 200 ? 60 : 10), px.y());
  };
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d from = RandomPixel(rng);
    pairs.push_back({from, moved(from)});
  }
  const ImageMotion motion(pairs);
  EXPECT_LT((motion({80, 240}) - moved({80, 240})).norm(), 4);
  EXPECT_LT((motion({500, 100}) - moved({500, 100})).norm(), 4);
  const Segment2 segment = motion(Segment2{{80, 100}, {100, 300}});
  EXPECT_LT((segment.start - Eigen::Vector2d(140, 100)).norm(), 4);
  EXPECT_LT((segment.end - Eigen::Vector2d(160, 300)).norm(), 4);
}

}  // namespace matching_test
}  // namespace plumbline
