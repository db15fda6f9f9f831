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

}  // namespace
}  // namespace plumbline
