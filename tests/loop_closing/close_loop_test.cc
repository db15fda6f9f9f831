// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/close_loop.h"

#include "plumbline/loop_closing/loop_closer.h"
#include "plumbline/loop_closing/verify_loop.h"
#include "plumbline/map/covisibility.h"

#include "tests/loop_closing/loop_scene.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CountOf;
using testing::LargestShift;
using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;
using testing::WorstPlace;

LoopEdge EdgeOf(const LoopScene& scene, KeyFrameId query, KeyFrameId candidate) {
  return *VerifyLoop(scene.map, query, scene.map, candidate, scene.Imaging(), {});
}

EssentialGraph Essential(const LoopScene& scene, bool free_scale = false) {
  return MakeEssentialGraph(scene.map, free_scale, {}, 60);
}

LoopScene Drifted(bool depth = true) {
  LoopSceneOptions options;
  options.sensor.depth = depth;
  options.drift = depth ? testing::GrowingDrift : testing::ShrinkingDrift;
  return MakeLoopScene(options);
}

constexpr KeyFrameId kQuery{45};
constexpr KeyFrameId kCandidate{5};

TEST(CloseLoop, BringsADriftedMapBack) {
  LoopScene scene = Drifted();
  const double before = WorstPlace(scene);
  const auto closed =
      CloseLoop(scene.map, Essential(scene), {}, EdgeOf(scene, kQuery, kCandidate), {});
  ASSERT_TRUE(closed) << NameOf(closed.error());
  const Map drifted = scene.map;
  scene.map.Apply(closed->edit);
  scene.map.CheckInvariants();
  EXPECT_GT(before, 0.15);
  EXPECT_LT(WorstPlace(scene), 0.3 * before);
  const int merged_points = CountOf<edit::MergePoints>(closed->edit);
  EXPECT_GT(merged_points, 100);
  EXPECT_GT(CountOf<edit::MergeLines>(closed->edit), 10);
  EXPECT_EQ(scene.map.points().size(),
            drifted.points().size() - static_cast<std::size_t>(merged_points));
  EXPECT_NEAR(LargestShift(drifted, scene.map), before, 0.3 * before);
}

TEST(CloseLoop, LeavesTheOldestKeyFrameWhereItIs) {
  LoopScene scene = Drifted();
  const Rigid3 first = scene.map.PoseOf(KeyFrameId{0});
  scene.map.Apply(
      CloseLoop(scene.map, Essential(scene), {}, EdgeOf(scene, kQuery, kCandidate), {})->edit);
  EXPECT_LT(CentreDistance(first, scene.map.PoseOf(KeyFrameId{0})), 1e-12);
  EXPECT_NEAR(scene.map.Find(KeyFrameId{0})->scale, 1, 1e-12);
}

TEST(CloseLoop, UndoesTheDriftOfScaleOfOneCamera) {
  LoopScene scene = Drifted(false);
  const double before = WorstPlace(scene);
  const double unit = scene.map.Find(kQuery)->scale;
  EXPECT_LT(unit, 0.9);
  const auto closed =
      CloseLoop(scene.map, Essential(scene, true), {}, EdgeOf(scene, kQuery, kCandidate), {});
  ASSERT_TRUE(closed) << NameOf(closed.error());
  scene.map.Apply(closed->edit);
  scene.map.CheckInvariants();
  EXPECT_NEAR(scene.map.Find(kQuery)->scale, 1, 0.02);
  EXPECT_LT(WorstPlace(scene), 0.45 * before);
}

TEST(CloseLoop, TiesTheMapTogether) {
  LoopScene scene = Drifted();
  scene.map.Apply(
      CloseLoop(scene.map, Essential(scene), {}, EdgeOf(scene, kQuery, kCandidate), {})->edit);
  EXPECT_GT(static_cast<int>(Covisible(scene.map, kQuery, 50).size()), 0);
  bool candidate_is_covisible = false;
  for (const auto& other : Covisible(scene.map, kQuery, 50)) {
    candidate_is_covisible = candidate_is_covisible || other.id == kCandidate;
  }
  EXPECT_TRUE(candidate_is_covisible);
}

TEST(CloseLoop, RefusesWhatBendsOdometry) {
  LoopScene scene = Drifted();
  LoopEdge edge = EdgeOf(scene, kQuery, kCandidate);
  edge.candidate_from_query.translation += Eigen::Vector3d(0, 8, 0);
  const auto closed = CloseLoop(scene.map, Essential(scene), {}, edge, {});
  ASSERT_FALSE(closed);
  EXPECT_TRUE(closed.error() == ClosingRefusal::kBendsOdometry ||
              closed.error() == ClosingRefusal::kContradicted)
      << NameOf(closed.error());
}

TEST(CloseLoop, RefusesWhatOtherLoopsContradict) {
  LoopScene scene = Drifted();
  const std::vector<LoopEdge> earlier{EdgeOf(scene, KeyFrameId{43}, KeyFrameId{3}),
                                      EdgeOf(scene, KeyFrameId{44}, KeyFrameId{4})};
  LoopEdge edge = EdgeOf(scene, kQuery, kCandidate);
  edge.candidate_from_query.translation += Eigen::Vector3d(0, 1.5, 0);
  const auto closed = CloseLoop(scene.map, Essential(scene), earlier, edge, {});
  ASSERT_FALSE(closed);
  EXPECT_TRUE(closed.error() == ClosingRefusal::kBendsOdometry ||
              closed.error() == ClosingRefusal::kContradicted)
      << NameOf(closed.error());
}

TEST(CloseLoop, RefusesKeyFramesThatAreNotTied) {
  LoopScene scene = Drifted();
  LoopEdge edge = EdgeOf(scene, kQuery, kCandidate);
  edge.query = edge.candidate;
  EXPECT_EQ(CloseLoop(scene.map, Essential(scene), {}, edge, {}).error(),
            ClosingRefusal::kOutOfMap);
}

TEST(CloseLoop, GivesTheSameEveryTime) {
  LoopScene one = Drifted();
  LoopScene other = Drifted();
  for (LoopScene* scene : {&one, &other}) {
    scene->map.Apply(
        CloseLoop(scene->map, Essential(*scene), {}, EdgeOf(*scene, kQuery, kCandidate), {})->edit);
  }
  for (const auto& [id, keyframe] : one.map.keyframes()) {
    EXPECT_EQ(keyframe.frame.cam_from_world.translation, other.map.PoseOf(id).translation);
  }
}

TEST(FusePairs, LeavesPairsApartThatAKeyFrameShowsBothOf) {
  const LoopScene scene = MakeLoopScene({});
  const auto& matches = scene.map.Find(KeyFrameId{5})->frame.points;
  std::vector<PointId> shown;
  for (const PointId id : matches) {
    if (id.valid()) shown.push_back(id);
  }
  const std::vector<LandmarkPair<PointId>> pairs{{shown[0], shown[1]}};
  EXPECT_TRUE(FusePairs(scene.map, pairs, {}).empty());
}

TEST(FusePairs, TakesNoLandmarkTwice) {
  LoopScene scene = MakeLoopScene({});
  const PointId first = scene.map.points().begin()->first;
  const PointId last = scene.map.points().rbegin()->first;
  const std::vector<LandmarkPair<PointId>> pairs{{last, first}, {last, first}};
  const MapEdit edit = FusePairs(scene.map, pairs, {});
  EXPECT_EQ(edit.size(), 2U);
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  EXPECT_EQ(scene.map.Current(last), first);
}

TEST(FusePairs, GivesLinesAnIntervalThatCoversBoth) {
  LoopScene scene = MakeLoopScene({});
  const LoopEdge edge = EdgeOf(scene, kQuery, kCandidate);
  ASSERT_FALSE(edge.lines.empty());
  const auto pair = edge.lines.front();
  MapLine gone = *scene.map.Find(pair.in_query);
  const double beyond = gone.end + 1;
  scene.map.Apply({edit::MoveLine{gone.id, gone.line, gone.start, beyond, gone.information}});
  scene.map.Apply(FusePairs(scene.map, {}, edge.lines));
  EXPECT_NEAR(scene.map.Find(pair.in_candidate)->end, beyond, 1e-6);
}

}  // namespace

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
    options_.pause = 0;
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
  // Points outside the surroundings stay merged.
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
