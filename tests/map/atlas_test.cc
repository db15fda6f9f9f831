// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/atlas.h"

#include "plumbline/base/error.h"

#include "tests/map/map_fixture.h"
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Atlas, HasNoActiveMapBeforeTheFirst) {
  Atlas atlas;
  EXPECT_TRUE(atlas.empty());
  EXPECT_FALSE(atlas.active_id().valid());
  EXPECT_THROW(atlas.active(), BugError);
  EXPECT_EQ(atlas.NextKeyFrameId(), KeyFrameId{0});
  EXPECT_EQ(atlas.Find(MapId{0}), nullptr);
}

TEST(Atlas, NoTwoMapsUseAnIdOfALandmark) {
  Atlas atlas;
  Map& first = atlas.Start();
  first.Apply({edit::AddKeyFrame{BlankKeyFrame(0, -1)},
               edit::AddPoint{PointSeenBy(4, {{KeyFrameId{0}, 1}})}});
  Map& second = atlas.Start();
  EXPECT_EQ(second.id(), MapId{1});
  EXPECT_EQ(second.NextPointId(), PointId{5});
  second.Apply({edit::AddKeyFrame{BlankKeyFrame(1, -1)},
                edit::AddLine{LineSeenBy(7, {{KeyFrameId{1}, 1}})}});
  EXPECT_EQ(atlas.NextKeyFrameId(), KeyFrameId{2});
  // Back in the first one.
  EXPECT_EQ(&atlas.Activate(MapId{0}), atlas.Find(MapId{0}));
  EXPECT_EQ(atlas.active_id(), MapId{0});
  EXPECT_EQ(atlas.active().NextLineId(), LineId{8});
  EXPECT_EQ(atlas.active().NextPointId(), PointId{5});
}

TEST(Atlas, TakesInASavedMapUnderItsId) {
  Map saved(MapId{3});
  saved.Apply({edit::AddKeyFrame{BlankKeyFrame(12, -1)}});
  Atlas atlas;
  atlas.Adopt(saved);
  EXPECT_FALSE(atlas.active_id().valid());
  EXPECT_EQ(atlas.NextKeyFrameId(), KeyFrameId{13});
  EXPECT_EQ(atlas.Start().id(), MapId{4});
  EXPECT_THROW(atlas.Adopt(std::move(saved)), BugError);
  EXPECT_THROW(atlas.Activate(MapId{9}), BugError);
}

// Two maps with two keyframes each; the second has lost its middle one, and two points are one.
Atlas TwoMaps() {
  Atlas atlas;
  Map& first = atlas.Start();
  first.Apply({edit::AddKeyFrame{BlankKeyFrame(0, -1)},
               edit::AddKeyFrame{BlankKeyFrame(1, 0)},
               edit::AddPoint{PointSeenBy(0, {{KeyFrameId{0}, 1}})}});
  Map& second = atlas.Start();
  second.Apply({edit::AddKeyFrame{BlankKeyFrame(2, -1)},
                edit::AddKeyFrame{BlankKeyFrame(3, 2)},
                edit::AddKeyFrame{BlankKeyFrame(4, 3)},
                edit::AddPoint{PointSeenBy(1, {{KeyFrameId{2}, 1}})},
                edit::AddPoint{PointSeenBy(2, {{KeyFrameId{4}, 1}})},
                edit::AddLine{LineSeenBy(0, {{KeyFrameId{4}, 0}})},
                edit::MergePoints{PointId{2}, PointId{1}},
                edit::RemoveKeyFrame{KeyFrameId{3}}});
  return atlas;
}

Similarity3 SomeSimilarity() {
  return {2, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY())), {1, 2, 3}};
}

TEST(Atlas, AMapThatIsJoinedMovesAsAWhole) {
  Atlas atlas = TwoMaps();
  const Map before = *atlas.Find(MapId{1});
  const Map& joined = atlas.Join(MapId{0}, MapId{1}, SomeSimilarity());
  joined.CheckInvariants();
  EXPECT_EQ(joined.keyframes().size(), 4U);
  for (const std::int64_t k : {2, 3, 4}) {  // 3 is none any more
    const KeyFrameId id{k};
    EXPECT_NEAR(joined.PlaceOf(id).scale, 2, 1e-12);
    for (const PointId point : {PointId{2}}) {
      const Eigen::Vector3d was = before.PoseOf(id) * before.Find(point)->position;
      const Eigen::Vector3d is = joined.PoseOf(id) * joined.Find(point)->position;
      EXPECT_LT((is - 2 * was).norm(), 1e-9) << k;
    }
  }
  EXPECT_EQ(joined.Current(PointId{1}), PointId{2});
  EXPECT_EQ(joined.NumberOf(KeyFrameId{2}), 2);
  EXPECT_EQ(joined.NumberOf(KeyFrameId{3}), 3);
  EXPECT_NE(joined.Find(LineId{0}), nullptr);
}

TEST(Atlas, WhatAMapWasCalledStandsForTheOneThatTookItIn) {
  Atlas atlas = TwoMaps();
  EXPECT_EQ(atlas.active_id(), MapId{1});
  EXPECT_EQ(atlas.Current(MapId{1}), MapId{1});
  atlas.Join(MapId{0}, MapId{1}, {});
  EXPECT_EQ(atlas.active_id(), MapId{0});
  EXPECT_EQ(atlas.Find(MapId{1}), nullptr);
  EXPECT_EQ(atlas.Current(MapId{1}), MapId{0});
  // Nothing new gets an old name.
  EXPECT_EQ(atlas.active().NextPointId(), PointId{3});
  EXPECT_EQ(atlas.NextKeyFrameId(), KeyFrameId{5});
  EXPECT_EQ(atlas.Start().id(), MapId{2});
  atlas.Join(MapId{0}, MapId{2}, {});
  EXPECT_EQ(atlas.Current(MapId{2}), MapId{0});
  EXPECT_THROW(atlas.Join(MapId{0}, MapId{0}, {}), BugError);
  EXPECT_THROW(atlas.Join(MapId{0}, MapId{2}, {}), BugError);
  atlas.Start();
  EXPECT_THROW(atlas.Join(MapId{3}, MapId{0}, {}), BugError);
}

}  // namespace
}  // namespace plumbline
