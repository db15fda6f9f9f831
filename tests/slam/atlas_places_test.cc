// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_places.h"

#include "tests/support/most_alike.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Keyframes of a walk, one after the other, into whatever map is the active one.
class AtlasPlaces : public testing::Test {
 protected:
  KeyFrameId Take() {
    const KeyFrameId id = atlas_.NextKeyFrameId();
    const KeyFrameId parent = atlas_.active().keyframes().empty()
                                  ? KeyFrameId{}
                                  : atlas_.active().keyframes().rbegin()->first;
    atlas_.active().Apply({edit::AddKeyFrame{{id, parent, FrameAt(static_cast<int>(id.value))}}});
    Follow(atlas_, &index_);
    return id;
  }

  Frame FrameAt(int step) const {
    Rng rng(4, "walk", static_cast<std::uint64_t>(step));
    const Rigid3 pose = PoseOnPath(6 * step);
    return MakeFrame(FrameId{step}, pose, Sense(world_, pose, {}, rng));
  }

  SyntheticWorld world_ = MakeSyntheticWorld(400, 80);
  Atlas atlas_;
  PlaceIndex index_;
};

TEST_F(AtlasPlaces, HoldWhatTheMapsHold) {
  atlas_.Start();
  for (int i = 0; i < 4; ++i) Take();
  atlas_.Start();
  Take();
  Take();
  EXPECT_THAT(index_.Ids(),
              ElementsAre(KeyFrameId{0},
                          KeyFrameId{1},
                          KeyFrameId{2},
                          KeyFrameId{3},
                          KeyFrameId{4},
                          KeyFrameId{5}));
}

TEST_F(AtlasPlaces, TellWhichMapHasAKeyFrame) {
  atlas_.Start();
  Take();
  Take();
  atlas_.Start();
  Take();
  EXPECT_EQ(MapOf(atlas_, KeyFrameId{1}), atlas_.Find(MapId{0}));
  EXPECT_EQ(MapOf(atlas_, KeyFrameId{2}), atlas_.Find(MapId{1}));
  atlas_.Find(MapId{0})->Apply({edit::RemoveKeyFrame{KeyFrameId{1}}});
  EXPECT_EQ(MapOf(atlas_, KeyFrameId{1}), nullptr);
}

TEST_F(AtlasPlaces, LoseWhatLeavesTheMaps) {
  atlas_.Start();
  for (int i = 0; i < 4; ++i) Take();
  atlas_.active().Apply({edit::RemoveKeyFrame{KeyFrameId{1}}});
  Follow(atlas_, &index_);
  EXPECT_THAT(index_.Ids(), ElementsAre(KeyFrameId{0}, KeyFrameId{2}, KeyFrameId{3}));
  // One comes and one leaves at once, the newest too.
  atlas_.active().Apply({edit::RemoveKeyFrame{KeyFrameId{3}}});
  Take();
  EXPECT_THAT(index_.Ids(), ElementsAre(KeyFrameId{0}, KeyFrameId{2}, KeyFrameId{4}));
}

TEST_F(AtlasPlaces, TakeInAdoptedMaps) {
  Map adopted(MapId{7});
  adopted.Apply({edit::AddKeyFrame{{KeyFrameId{3}, KeyFrameId{}, FrameAt(3)}}});
  Map older(MapId{8});
  older.Apply({edit::AddKeyFrame{{KeyFrameId{1}, KeyFrameId{}, FrameAt(1)}}});
  atlas_.Adopt(adopted);
  Follow(atlas_, &index_);
  atlas_.Adopt(older);
  Follow(atlas_, &index_);
  EXPECT_THAT(index_.Ids(), ElementsAre(KeyFrameId{1}, KeyFrameId{3}));
}

TEST_F(AtlasPlaces, NoticeThatAsManyCameAsLeft) {
  Map adopted(MapId{7});
  for (const int step : {3, 5}) {
    const KeyFrameId parent = step == 3 ? KeyFrameId{} : KeyFrameId{3};
    adopted.Apply({edit::AddKeyFrame{{KeyFrameId{step}, parent, FrameAt(step)}}});
  }
  Map older(MapId{8});
  older.Apply({edit::AddKeyFrame{{KeyFrameId{1}, KeyFrameId{}, FrameAt(1)}}});
  atlas_.Adopt(adopted);
  Follow(atlas_, &index_);
  EXPECT_THAT(index_.Ids(), ElementsAre(KeyFrameId{3}, KeyFrameId{5}));
  atlas_.Find(MapId{7})->Apply({edit::RemoveKeyFrame{KeyFrameId{5}}});
  atlas_.Adopt(older);
  Follow(atlas_, &index_);
  EXPECT_THAT(index_.Ids(), ElementsAre(KeyFrameId{1}, KeyFrameId{3}));
}

// Over several pages of ids, in maps that begin, grow, shrink and are joined.
TEST_F(AtlasPlaces, FollowWhateverChanges) {
  Rng rng(8, "changes");
  const auto nothing = IndexFeatures(world_.camera, {});
  std::vector<KeyFrameId> there;
  for (int round = 0; round < 60; ++round) {
    if (round % 20 == 0) atlas_.Start();
    for (int k = 0; k < 5; ++k) {
      const KeyFrameId id = atlas_.NextKeyFrameId();
      const auto& keyframes = atlas_.active().keyframes();
      const KeyFrameId parent = keyframes.empty() ? KeyFrameId{} : keyframes.rbegin()->first;
      const Frame frame{FrameId{id.value}, id.value, {}, nothing, {}, {}};
      atlas_.active().Apply({edit::AddKeyFrame{{id, parent, frame}}});
    }
    for (int k = 0; k < 3 && !there.empty(); ++k) {
      const KeyFrameId gone = there[rng.Index(there.size())];
      const Map* map = MapOf(atlas_, gone);
      if (map != nullptr) atlas_.Find(map->id())->Apply({edit::RemoveKeyFrame{gone}});
    }
    if (round == 50) atlas_.Join(MapId{0}, MapId{1}, {});
    Follow(atlas_, &index_);
    there.clear();
    for (const auto& [id, map] : atlas_.maps()) {
      for (const auto& [keyframe, content] : map.keyframes()) there.push_back(keyframe);
    }
    std::sort(there.begin(), there.end());
    ASSERT_EQ(index_.Ids(), there) << round;
  }
  EXPECT_GT(there.size(), PlaceIndex::kPage);
}

TEST_F(AtlasPlaces, AnswerAsThoseOfARunThatGoesOn) {
  atlas_.Start();
  for (int i = 0; i < 6; ++i) Take();
  atlas_.active().Apply({edit::RemoveKeyFrame{KeyFrameId{2}}});
  Take();
  PlaceIndex anew;
  Follow(atlas_, &anew);
  const auto all = [](KeyFrameId) { return true; };
  const auto a = index_.Query(FrameAt(9).features(), 10, all);
  const auto b = anew.Query(FrameAt(9).features(), 10, all);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].score, b[i].score);
  }
}

TEST_F(AtlasPlaces, AreThoseOfOneMapWhereItIsAskedFor) {
  const Map& first = atlas_.Start();
  for (int i = 0; i < 5; ++i) Take();
  EXPECT_EQ(MostAlike(index_, first, FrameAt(2).features(), 1).at(0), KeyFrameId{2});
  EXPECT_EQ(MostAlike(index_, first, FrameAt(2).features(), 3).size(), 3U);
  const Map& second = atlas_.Start();
  EXPECT_THAT(MostAlike(index_, second, FrameAt(2).features(), 3), IsEmpty());
  const KeyFrameId only = Take();
  EXPECT_THAT(MostAlike(index_, second, FrameAt(5).features(), 3), ElementsAre(only));
}

}  // namespace
}  // namespace plumbline
