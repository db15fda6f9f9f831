// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/combined_atlases.h"

#include "tests/map/map_fixture.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Session SessionNamed(const std::string& name) {
  Session session;
  session.uuid = UuidOf(name);
  session.data = name;
  return session;
}

// One map with two keyframes, of the last session, and a point that is young.
SavedAtlas AtlasOf(const std::vector<std::string>& sessions) {
  SavedAtlas saved;
  Map& map = saved.atlas.Start();
  for (const std::int64_t id : {0, 1}) {
    KeyFrame keyframe = BlankKeyFrame(id, id - 1);
    if (!sessions.empty()) {
      keyframe.session = SessionId{static_cast<std::int64_t>(sessions.size()) - 1};
    }
    map.Apply({edit::AddKeyFrame{keyframe}});
  }
  map.Apply({edit::AddPoint{PointSeenBy(0, {{KeyFrameId{0}, 1}})}});
  for (const std::string& name : sessions) saved.context.sessions.push_back(SessionNamed(name));
  saved.context.stereo_evidence.weighted.setConstant(2);
  saved.context.maps[map.id()] = {UuidOf("map"), {{PointId{0}}, {}}};
  return saved;
}

TEST(CombineAtlases, PutsTheMapsSideBySide) {
  const SavedAtlas first = AtlasOf({"morning"});
  const CombinedAtlases gathered = CombineAtlases(first, AtlasOf({"evening"}));
  const SavedAtlas& all = gathered.saved;
  EXPECT_EQ(all.atlas.maps().size(), 2U);
  EXPECT_EQ(all.atlas.active_id(), MapId{0});
  EXPECT_EQ(gathered.second, MapId{1});
  const Map& second = *all.atlas.Find(gathered.second);
  EXPECT_EQ(second.keyframes().begin()->first, KeyFrameId{2});
  EXPECT_EQ(second.keyframes().begin()->second.session, SessionId{1});
  ASSERT_EQ(all.context.sessions.size(), 2U);
  EXPECT_EQ(all.context.sessions[1].data, "evening");
  EXPECT_EQ(all.context.maps.at(MapId{1}).young.points.front(), PointId{1});
  EXPECT_EQ(all.context.stereo_evidence.weighted(0), 4);
}

TEST(CombineAtlases, CountsASessionAndItsEvidenceOnce) {
  const SavedAtlas first = AtlasOf({"morning", "noon"}), second = AtlasOf({"morning", "evening"});
  const CombinedAtlases gathered = CombineAtlases(first, second);
  ASSERT_EQ(gathered.saved.context.sessions.size(), 3U);
  const Map& map = *gathered.saved.atlas.Find(gathered.second);
  EXPECT_EQ(map.keyframes().begin()->second.session, SessionId{2});
  EXPECT_EQ(gathered.saved.context.stereo_evidence.weighted(0), 2);
}

TEST(CombineAtlases, LeavesTheEvidenceOfAnotherRig) {
  SavedAtlas second = AtlasOf({"evening"});
  second.context.camera.fx = 500;
  const CombinedAtlases gathered = CombineAtlases(AtlasOf({"morning"}), second);
  EXPECT_EQ(gathered.saved.context.stereo_evidence.weighted(0), 2);
}

TEST(CombineAtlases, NamesSessionsOfFilesThatKnowNone) {
  const CombinedAtlases gathered = CombineAtlases(AtlasOf({}), AtlasOf({"evening"}));
  const SavedAtlas& all = gathered.saved;
  ASSERT_EQ(all.context.sessions.size(), 2U);
  EXPECT_EQ(all.context.sessions[0].uuid, Uuid());
  EXPECT_EQ(all.atlas.Find(gathered.second)->keyframes().begin()->second.session, SessionId{1});
}

TEST(CombineAtlases, HasNoSecondMapWhereThereIsNone) {
  EXPECT_FALSE(CombineAtlases(AtlasOf({"morning"}), SavedAtlas()).second.valid());
}

TEST(SettleJoined, GivesYoungLandmarksToTheMapThatStays) {
  CombinedAtlases gathered = CombineAtlases(AtlasOf({"morning"}), AtlasOf({"evening"}));
  SavedAtlas& all = gathered.saved;
  all.atlas.Join(MapId{0}, gathered.second, {});
  SettleJoined(all);
  EXPECT_EQ(all.context.maps.size(), 1U);
  EXPECT_EQ(all.context.maps.at(MapId{0}).young.points, (std::vector{PointId{0}, PointId{1}}));
}

}  // namespace
}  // namespace plumbline
