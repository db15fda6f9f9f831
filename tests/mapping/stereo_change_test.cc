// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_change.h"

#include <memory>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const RectifiedCamera kCamera{400, 400, 320, 240, 0.1, 640, 480};
constexpr auto kSlice = static_cast<std::int64_t>(StereoChange::kSlice);

StereoCorrection By(double px) { return {kCamera, px * Vector6d::Unit(0)}; }

// A keyframe with one point, of this disparity.
void AddKeyFrame(Map& map, double disparity) {
  Features features;
  features.points.resize(1);
  features.point_disparity = {Disparity{disparity, 1}};
  KeyFrame keyframe;
  keyframe.id = map.NextKeyFrameId();
  keyframe.frame.indexed = IndexFeatures(kCamera, std::move(features));
  keyframe.frame.points.resize(1);
  map.Apply({edit::AddKeyFrame{keyframe}});
}

Map MapOf(std::int64_t keyframes) {
  Map map;
  for (std::int64_t i = 0; i < keyframes; ++i) AddKeyFrame(map, 10 + static_cast<double>(i));
  return map;
}

// By how much each keyframe of the map is corrected; they agree.
double CorrectionOf(const Map& map) {
  const auto of = [&](const KeyFrame& keyframe) {
    return 10 + static_cast<double>(keyframe.id.value) -
           keyframe.frame.features().point_disparity[0]->px;
  };
  const double first = of(map.keyframes().begin()->second);
  for (const auto& [id, keyframe] : map.keyframes()) {
    EXPECT_NEAR(of(keyframe), first, 1e-9) << id.value;
    EXPECT_EQ(keyframe.frame.indexed->correction, map.correction()) << id.value;
  }
  return first;
}

TEST(StereoChange, IsMadeAtOnceInASmallMap) {
  Map map = MapOf(kSlice);
  StereoChange change;
  change.Begin(map, By(0.5));
  EXPECT_TRUE(change.Running(map));
  change.Step(map);
  EXPECT_FALSE(change.Running(map));
  EXPECT_DOUBLE_EQ(CorrectionOf(map), 0.5);
}

// The map is never in between, and keyframes that come meanwhile have the same correction.
TEST(StereoChange, TakesEffectWhenAllKeyFramesAreReady) {
  Map map = MapOf(2 * kSlice + 10);
  StereoChange change;
  change.Begin(map, By(0.5));
  for (int step = 0; step < 2; ++step) {
    change.Step(map);
    EXPECT_EQ(CorrectionOf(map), 0);
    AddKeyFrame(map, 10 + static_cast<double>(map.NextKeyFrameId().value));
  }
  const auto before = map.keyframes().begin()->second.frame.indexed;
  change.Step(map);
  EXPECT_FALSE(change.Running(map));
  EXPECT_DOUBLE_EQ(CorrectionOf(map), 0.5);
  // What nobody needs is let go a part at a time, too.
  EXPECT_GT(before.use_count(), 1);
  for (int step = 0; step < 3; ++step) change.Step(map);
  EXPECT_EQ(before.use_count(), 1);
}

// The map that took it in has a correction of its own.
TEST(StereoChange, IsGivenUpWhereTheMapIsJoinedToAnotherOne) {
  Atlas atlas;
  for (int i = 0; i < 2; ++i) atlas.Start();
  const Map changing(MapId{1});
  StereoChange change;
  change.Begin(changing, By(0.5));
  change.FollowJoins(atlas);
  EXPECT_TRUE(change.Running(changing));
  atlas.Join(MapId{0}, MapId{1}, {});
  change.FollowJoins(atlas);
  EXPECT_FALSE(change.Running(changing));
}

TEST(StereoChange, IsOfOneMapAndMayBeGivenUp) {
  Map map = MapOf(kSlice + 10), other(MapId{1});
  AddKeyFrame(other, 10);
  StereoChange change;
  change.Begin(map, By(0.5));
  EXPECT_FALSE(change.Running(other));
  change.Step(other);
  EXPECT_EQ(CorrectionOf(other), 0);
  change.GiveUp();
  change.Step(map);
  change.Step(map);
  EXPECT_EQ(CorrectionOf(map), 0);
}

}  // namespace
}  // namespace plumbline
