// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_decision.h"

#include "plumbline/tracking/tracker.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(DecideKeyFrame, IsSoonerWithASingleCamera) {
  const KeyFramePolicyOptions options;
  KeyFrameSituation situation{
      .frames_since_keyframe = 5, .shared_landmarks = 170, .reference_landmarks = 200};
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kNone);
  situation.monocular = true;
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kFewLandmarks);
  situation.shared_landmarks = 180;
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kNone);
}

TEST(DecideKeyFrame, ExpectsLessOfAFrameMeasuredWithFewerFeatures) {
  const KeyFramePolicyOptions options;
  KeyFrameSituation situation{.frames_since_keyframe = 5,
                              .shared_landmarks = 80,
                              .reference_landmarks = 200,
                              .close_tracked = 60,
                              .close_untracked = 40};
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kFewLandmarks);
  situation.share_of_reference = 0.5;
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kNone);
  situation.share_of_usual = 0.5;  // 40 of 35 new ones, but 60 of 50 tracked
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kNone);
  situation.close_tracked = 49;
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kNeedsClosePoints);
  situation.shared_landmarks = 34;
  EXPECT_EQ(DecideKeyFrame(situation, options), KeyFrameReason::kAlmostLost);
}

TEST(DecideKeyFrame, FollowsTheTable) {
  KeyFramePolicyOptions options;
  options.max_frames = 20;
  options.min_frames = 2;
  struct Row {
    KeyFrameSituation situation;  // frames, shared, reference, close tracked, close untracked
    KeyFrameReason expected;
  };
  const Row rows[] = {
      {{5, 200, 200, 150, 0}, KeyFrameReason::kNone},
      {{5, 140, 200, 150, 0}, KeyFrameReason::kNone},
      {{5, 139, 200, 150, 0}, KeyFrameReason::kFewLandmarks},
      {{1, 139, 200, 150, 0}, KeyFrameReason::kNone},  // too soon
      {{2, 139, 200, 150, 0}, KeyFrameReason::kFewLandmarks},
      {{1, 69, 200, 150, 0}, KeyFrameReason::kAlmostLost},  // at once
      {{1, 70, 200, 150, 0}, KeyFrameReason::kNone},
      {{5, 69, 200, 150, 0}, KeyFrameReason::kAlmostLost},
      {{5, 200, 200, 99, 71}, KeyFrameReason::kNeedsClosePoints},
      {{1, 200, 200, 99, 71}, KeyFrameReason::kNone},
      {{5, 200, 200, 100, 71}, KeyFrameReason::kNone},
      {{5, 200, 200, 99, 70}, KeyFrameReason::kNone},
      {{19, 200, 200, 150, 0}, KeyFrameReason::kNone},
      {{20, 200, 200, 150, 0}, KeyFrameReason::kLongAgo},
      {{20, 139, 200, 99, 71}, KeyFrameReason::kFewLandmarks},
      {{20, 200, 200, 99, 71}, KeyFrameReason::kNeedsClosePoints},
      {{5, 0, 0, 150, 0}, KeyFrameReason::kNone},  // nothing to compare with
      {{20, 0, 0, 150, 0}, KeyFrameReason::kLongAgo},
  };
  int number = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(DecideKeyFrame(row.situation, options), row.expected) << "row " << number;
    ++number;
  }
}

TEST(NextState, FollowsTheTable) {
  using State = TrackerState;
  struct Row {
    State state;
    bool has_pose;
    int lost_frames;
    State expected;
  };
  const Row rows[] = {
      {State::kInitializing, false, 1, State::kInitializing},
      {State::kInitializing, false, 50, State::kInitializing},
      {State::kInitializing, true, 0, State::kTracking},
      {State::kTracking, true, 0, State::kTracking},
      {State::kTracking, false, 1, State::kLost},
      {State::kLost, false, 9, State::kLost},
      {State::kLost, false, 10, State::kInitializing},
      {State::kLost, true, 0, State::kTracking},
  };
  int number = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(NextState(row.state, row.has_pose, row.lost_frames, 10), row.expected)
        << "row " << number;
    ++number;
  }
  EXPECT_EQ(NextState(State::kTracking, false, 1, 1), State::kInitializing);
}

constexpr int kFramesSince = 5;

// A map whose newest keyframe is the one asked about, and a frame that stands where it does.
struct KnownKeyFrame {
  explicit KnownKeyFrame(int keyframes)
      : scene(MakeTrueMap(world, std::vector(static_cast<std::size_t>(keyframes), Rigid3{}), {})),
        snapshot(TakeSnapshot(scene.map, KeyFrameId{keyframes - 1})),
        frame(snapshot->reference->frame),
        association(AssociationOf(frame, *snapshot)) {}

  KeyFrameSituation Situation(double feature_share = 1, bool monocular = false) const {
    return SituationOf(frame, association, *snapshot, kFramesSince, feature_share, monocular);
  }
  int Landmarks() const {
    const auto valid = [](const auto& ids) {
      return std::count_if(ids.begin(), ids.end(), [](auto id) { return id.valid(); });
    };
    return static_cast<int>(valid(frame.points) + valid(frame.lines));
  }

  SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene;
  std::shared_ptr<const MapSnapshot> snapshot;
  Frame frame;
  LandmarkMatches association;
};

TEST(KeyFrameSituation, OfTheKeyframeItselfSharesAll) {
  const KnownKeyFrame known(4);
  const KeyFrameSituation situation = known.Situation();
  EXPECT_GT(situation.reference_landmarks, known.Landmarks() / 2);
  EXPECT_EQ(situation.shared_landmarks, situation.reference_landmarks);
  EXPECT_GT(situation.close_tracked, 0);
  EXPECT_EQ(situation.frames_since_keyframe, kFramesSince);
  EXPECT_EQ(situation.share_of_usual, 1);
  EXPECT_EQ(situation.share_of_reference, 1);
}

TEST(KeyFrameSituation, CountsLandmarksOfTwoViewsInAYoungMapAndWithOneCamera) {
  const KnownKeyFrame young(2);
  EXPECT_GT(young.Situation().reference_landmarks, young.Landmarks() / 2);
  const KnownKeyFrame old(6);
  EXPECT_GE(old.Situation(1, true).reference_landmarks, old.Situation().reference_landmarks);
  EXPECT_TRUE(old.Situation(1, true).monocular);
}

TEST(KeyFrameSituation, TellsNearPointsThatTheMapLacks) {
  KnownKeyFrame known(4);
  const int tracked = known.Situation().close_tracked;
  const int untracked = known.Situation().close_untracked;
  for (std::size_t i = 0; i < known.frame.points.size(); ++i) {
    known.frame.points[i] = {};
    known.association.matches.point_of_feature[i] = -1;
  }
  const KeyFrameSituation situation = known.Situation();
  EXPECT_EQ(situation.close_tracked, 0);
  EXPECT_EQ(situation.close_untracked, tracked + untracked);
  EXPECT_LT(situation.shared_landmarks, situation.reference_landmarks);
}

TEST(KeyFrameSituation, ExpectsLessWhereFeaturesAreShed) {
  KnownKeyFrame known(4);
  SyntheticWorld half = known.world;
  half.points.resize(half.points.size() / 2);
  half.lines.resize(half.lines.size() / 2);
  Rng rng(7);
  known.frame = MakeFrame(FrameId{9}, Rigid3{}, Sense(half, Rigid3{}, {}, rng));
  known.association = LandmarkMatches(known.frame.points.size(), known.frame.lines.size());
  const KeyFrameSituation situation = known.Situation(0.5);
  EXPECT_EQ(situation.share_of_usual, 0.5);
  EXPECT_NEAR(situation.share_of_reference, 0.5, 0.15);
}

}  // namespace

}  // namespace plumbline
