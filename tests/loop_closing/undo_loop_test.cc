// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/undo_loop.h"

#include "plumbline/loop_closing/loop_closer.h"
#include "plumbline/map/covisibility.h"

#include "tests/loop_closing/loop_scene.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace undo_loop_test {

using testing::CountOf;
using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;
using testing::WorstPlace;

constexpr KeyFrameId kQuery{45};
constexpr KeyFrameId kCandidate{5};

LoopScene Drifted() {
  LoopSceneOptions options;
  options.drift = testing::GrowingDrift;
  return MakeLoopScene(options);
}

bool AreTied(const Map& map) {
  const auto covisible = Covisible(map, kQuery);
  return std::any_of(covisible.begin(), covisible.end(), [](const CovisibleKeyFrame& other) {
    return other.id.value <= 10;
  });
}

struct Closed {
  int merged_points = 0, merged_lines = 0;
  double drift_chi2 = 0;
};

class UndoLoopTest : public ::testing::Test {
 protected:
  UndoLoopTest() {
    options_.closing.pause = 0;
    closer_ = std::make_unique<LoopCloser>(scene_.Imaging(), options_);
  }

  Closed Close() {
    const std::vector<KeyFrameId> candidates{kCandidate};
    const auto closure = closer_->Try(scene_.map, kQuery, candidates);
    EXPECT_TRUE(closure);
    if (!closure) return {};
    scene_.map.Apply(closure->edit);
    scene_.map.CheckInvariants();
    return {CountOf<edit::MergePoints>(closure->edit),
            CountOf<edit::MergeLines>(closure->edit),
            closer_->attempts().back().drift_chi2};
  }

  LoopScene scene_ = Drifted();
  LoopOptions options_;
  std::unique_ptr<LoopCloser> closer_;
};

TEST_F(UndoLoopTest, GivesBackTheLandmarksThatWereFused) {
  const std::size_t points = scene_.map.points().size();
  const std::size_t lines = scene_.map.lines().size();
  const Closed first = Close();
  EXPECT_TRUE(AreTied(scene_.map));
  scene_.map.Apply(UndoLoop(scene_.map, closer_->loops().front()));
  scene_.map.CheckInvariants();
  EXPECT_FALSE(AreTied(scene_.map));
  // What the surroundings do not show stays one.
  EXPECT_GT(static_cast<double>(scene_.map.points().size()),
            static_cast<double>(points) - 0.1 * first.merged_points);
  EXPECT_LE(scene_.map.points().size(), points);
  EXPECT_LE(scene_.map.lines().size(), lines);
}

TEST_F(UndoLoopTest, IsClosedAgain) {
  const Closed first = Close();
  const double closed = WorstPlace(scene_);
  scene_.map.Apply(UndoLoop(scene_.map, closer_->loops().front()));
  closer_ = std::make_unique<LoopCloser>(scene_.Imaging(), options_);
  const Closed again = Close();
  EXPECT_TRUE(AreTied(scene_.map));
  EXPECT_GT(again.merged_points, 0.9 * first.merged_points);
  EXPECT_GT(again.merged_lines, 0.8 * first.merged_lines);
  // The keyframes had stayed where the loop had brought them.
  EXPECT_LT(again.drift_chi2, 0.5 * first.drift_chi2 + 1);
  EXPECT_LT(WorstPlace(scene_), 1.1 * closed);
}

TEST_F(UndoLoopTest, LeavesAloneWhatNoLoopTies) {
  const auto edge = VerifyLoop(scene_.map, kQuery, scene_.map, kCandidate, scene_.Imaging(), {});
  ASSERT_TRUE(edge);
  EXPECT_TRUE(UndoLoop(scene_.map, *edge).empty());
  LoopEdge gone = *edge;
  gone.query = gone.candidate;
  EXPECT_TRUE(UndoLoop(scene_.map, gone).empty());
}

// A loop that was wrong and not noticed, then so many right ones that it stands alone.
TEST_F(UndoLoopTest, BelongsToALoopThatTheOthersLeaveOut) {
  const auto verified = [&](std::int64_t query, std::int64_t candidate) {
    return *VerifyLoop(
        scene_.map, KeyFrameId{query}, scene_.map, KeyFrameId{candidate}, scene_.Imaging(), {});
  };
  LoopEdge wrong = verified(44, 4);
  wrong.candidate_from_query.translation.y() += 0.6;
  closer_->Know(wrong);
  for (int i = 0; i < 10; ++i) closer_->Know(verified(41 + i % 4, 1 + i % 4));
  const std::vector<KeyFrameId> candidates{kCandidate};
  const auto closure = closer_->Try(scene_.map, kQuery, candidates);
  ASSERT_TRUE(closure);
  ASSERT_EQ(closure->withdrawn.size(), 1U);
  EXPECT_EQ(closure->withdrawn.front().query, wrong.query);
  EXPECT_EQ(closer_->loops().size(), 11U);
}

}  // namespace undo_loop_test
}  // namespace plumbline
