// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_events.h"

#include "tests/map/map_fixture.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

Recognition Seen(std::int64_t frame, std::int64_t keyframe, std::int64_t older) {
  Recognition place;
  place.frame = FrameId{frame};
  place.keyframe = KeyFrameId{keyframe};
  place.older = KeyFrameId{older};
  return place;
}

// One map with keyframes 0 to 5, the k-th at x = -k.
std::map<MapId, Map> OneMap() {
  std::map<MapId, Map> maps;
  maps.emplace(MapId{0}, ChainOfKeyFrames(6));
  return maps;
}

TEST(PlaceEvents, AreInTheOrderOfTheirFrames) {
  MapEvents events;
  events.loops = {Seen(30, 4, 0), Seen(50, 5, 1)};
  events.joins = {{Seen(40, 3, 2), MapId{0}, MapId{1}}};
  events.relocalizations = {{FrameId{35}, KeyFrameId{2}, 60, 7}};
  const auto placed = PlaceEvents(events, OneMap(), {{MapId{0}, {}}});
  ASSERT_EQ(placed.size(), 4U);
  EXPECT_EQ(placed[0].kind, RunEventKind::kLoop);
  EXPECT_EQ(placed[1].kind, RunEventKind::kRelocalization);
  EXPECT_EQ(placed[2].kind, RunEventKind::kJoin);
  EXPECT_EQ(placed[2].join->gone, MapId{1});
  EXPECT_EQ(placed[3].place.frame, FrameId{50});
  EXPECT_EQ(placed[1].place.points, 60);
  EXPECT_FALSE(placed[1].at);
  EXPECT_EQ(placed[1].older_at->x(), -2);
}

TEST(PlaceEvents, AreInTheWorldThatIsShown) {
  MapEvents events;
  events.loops = {Seen(30, 4, 1)};
  const Similarity3 shown{2, ExpSo3(Eigen::Vector3d::Zero()), {10, 0, 0}};
  const auto placed = PlaceEvents(events, OneMap(), {{MapId{0}, shown}});
  EXPECT_EQ(placed.front().map, MapId{0});
  EXPECT_EQ(placed.front().at->x(), 2);
  EXPECT_EQ(placed.front().older_at->x(), 8);
}

// Keyframes that were removed keep a place; those that no map has ever had do not.
TEST(PlaceEvents, HavePlacesAsLongAsAMapKnowsThem) {
  std::map<MapId, Map> maps = OneMap();
  maps.at(MapId{0}).Apply({edit::RemoveKeyFrame{KeyFrameId{4}}});
  MapEvents events;
  events.loops = {Seen(30, 4, 9)};
  const auto placed = PlaceEvents(events, maps, {{MapId{0}, {}}});
  EXPECT_EQ(placed.front().at->x(), -4);
  EXPECT_FALSE(placed.front().older_at);
  EXPECT_FALSE(placed.front().map);
}

}  // namespace
}  // namespace plumbline
