// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_decision.h"

#include "plumbline/tracking/tracker.h"

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

}  // namespace
}  // namespace plumbline
