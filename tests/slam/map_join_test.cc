// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/map_join.h"

#include "plumbline/base/error.h"

#include "tests/map/map_fixture.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Two maps with keyframes 0, 1 and 2, 3; the second one is active.
Atlas TwoMaps() {
  Atlas atlas;
  atlas.Start().Apply(
      {edit::AddKeyFrame{BlankKeyFrame(0, -1)}, edit::AddKeyFrame{BlankKeyFrame(1, 0)}});
  atlas.Start().Apply(
      {edit::AddKeyFrame{BlankKeyFrame(2, -1)}, edit::AddKeyFrame{BlankKeyFrame(3, 2)}});
  return atlas;
}

LoopEdge EdgeOf(std::int64_t query, std::int64_t candidate) {
  LoopEdge edge;
  edge.query = KeyFrameId{query};
  edge.candidate = KeyFrameId{candidate};
  edge.candidate_from_query = {2, ExpSo3({0, 0.3, 0}), {0.5, 0, 0}};
  return edge;
}

TEST(JoinMaps, PlacesTheYoungerMapAsTheEdgeSays) {
  for (const auto& [query, candidate] : {std::pair{3, 1}, std::pair{1, 3}}) {
    Atlas atlas = TwoMaps();
    const LoopEdge edge = EdgeOf(query, candidate);
    const Rigid3 oldest = atlas.Find(MapId{0})->PoseOf(KeyFrameId{0});
    const JoinedMaps joined = JoinMaps(edge, atlas);
    EXPECT_EQ(joined.kept, MapId{0});
    EXPECT_EQ(joined.gone, MapId{1});
    EXPECT_EQ(atlas.active_id(), MapId{0});
    const Map& map = atlas.active();
    EXPECT_EQ(map.keyframes().size(), 4U);
    EXPECT_EQ(map.PoseOf(KeyFrameId{0}).translation, oldest.translation);
    const KeyFramePose query_place = map.PlaceOf(edge.query);
    const KeyFramePose candidate_place = map.PlaceOf(edge.candidate);
    const Similarity3 relative =
        CandidateFromQueryToday(edge, query_place.scale, candidate_place.scale);
    EXPECT_NEAR(relative.scale, 1, 1e-12);
    const Rigid3 found = candidate_place.cam_from_world * Inverse(query_place.cam_from_world);
    EXPECT_LT((found.translation - relative.translation).norm(), 1e-12);
    EXPECT_LT(AngularDistance(found.rotation, relative.rotation), 1e-7);
  }
}

TEST(JoinMaps, IsForEdgesBetweenTwoMaps) {
  Atlas atlas = TwoMaps();
  EXPECT_THROW(JoinMaps(EdgeOf(1, 0), atlas), BugError);
  EXPECT_THROW(JoinMaps(EdgeOf(7, 0), atlas), BugError);
}

}  // namespace
}  // namespace plumbline
