// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/initial_map_edit.h"

#include "plumbline/base/error.h"
#include "plumbline/map/map.h"

#include "tests/support/initial_map_of.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const Rigid3 kWorldFromFirstCam{ExpSo3({0.1, -0.2, 0.3}), {1, 2, 3}};

struct StartedMap {
  SyntheticWorld world = MakeMonocularWorld(300, 80);
  InitialMap initial = InitialMapOf(world, {0, 8, 16});
  InitialMapEdit start =
      MakeInitialMapEdit(initial, world.Imaging(), kWorldFromFirstCam, KeyFrameId{5});
  Map map;

  StartedMap() { map.Apply(start.edit); }
};

TEST(MakeInitialMapEdit, EveryViewBecomesAKeyFrame) {
  const StartedMap s;
  s.map.CheckInvariants();
  ASSERT_EQ(s.start.keyframes, (std::vector<KeyFrameId>{{5}, {6}, {7}}));
  EXPECT_EQ(s.start.frames, (std::vector<FrameId>{{0}, {8}, {16}}));
  KeyFrameId parent;
  for (std::size_t i = 0; i < 3; ++i) {
    const KeyFrame* keyframe = s.map.Find(s.start.keyframes[i]);
    ASSERT_NE(keyframe, nullptr);
    EXPECT_EQ(keyframe->parent, parent);
    parent = keyframe->id;
    EXPECT_EQ(keyframe->frame.id, s.start.frames[i]);
    EXPECT_EQ(keyframe->frame.stamp_ns, s.initial.views[i].frame.stamp_ns);
    const Rigid3 expected = s.initial.views[i].cam_from_world * Inverse(kWorldFromFirstCam);
    EXPECT_LT(LogSe3(keyframe->frame.cam_from_world * Inverse(expected)).norm(), 1e-12);
  }
  EXPECT_EQ(s.map.NextKeyFrameId(), KeyFrameId{8});
}

TEST(MakeInitialMapEdit, LandmarksKeepTheirPlacesAndObservations) {
  const StartedMap s;
  ASSERT_EQ(s.map.points().size(), s.initial.points.size());
  ASSERT_EQ(s.map.lines().size(), s.initial.lines.size());
  ASSERT_GT(s.map.lines().size(), 20U);
  for (const auto& [id, point] : s.map.points()) {
    const InitialPoint& from = s.initial.points[static_cast<std::size_t>(id.value)];
    EXPECT_LT((point.position - kWorldFromFirstCam * from.position).norm(), 1e-12);
    EXPECT_EQ(point.observations.size(), from.observations.size());
    EXPECT_GT(point.reference_distance, 0);
    EXPECT_EQ(point.created_by, KeyFrameId{7});
  }
  for (const auto& [id, line] : s.map.lines()) {
    const InitialLine& from = s.initial.lines[static_cast<std::size_t>(id.value)];
    EXPECT_LT(line.line.DistanceTo(kWorldFromFirstCam * from.segment.start), 1e-9);
    EXPECT_LT((line.Interval().end - kWorldFromFirstCam * from.segment.end).norm(), 1e-9);
    EXPECT_EQ(line.observations.size(), from.observations.size());
    EXPECT_GT(line.information.trace(), 0);
    EXPECT_NEAR(line.view_direction.norm(), 1, 1e-9);
  }
}

TEST(NumberedFor, GivesLandmarksTheIdsThatFollowThoseOfOtherMaps) {
  const StartedMap first;
  Map second(MapId{1});
  second.ReserveIds(first.map.NextPointId(), first.map.NextLineId());
  second.Apply(NumberedFor(second, first.start.edit));
  second.CheckInvariants();
  ASSERT_EQ(second.points().size(), first.map.points().size());
  ASSERT_EQ(second.lines().size(), first.map.lines().size());
  EXPECT_EQ(second.points().begin()->first, first.map.NextPointId());
  EXPECT_EQ(second.lines().begin()->first, first.map.NextLineId());
  // With the looks that their observations give.
  const MapLine& line = second.lines().begin()->second;
  EXPECT_EQ(line.descriptor, first.map.lines().begin()->second.descriptor);
  EXPECT_EQ(line.information, first.map.lines().begin()->second.information);
}

TEST(MakeInitialMapEdit, NeedsTwoViews) {
  const SyntheticWorld world = MakeMonocularWorld(50, 0);
  EXPECT_THROW(
      MakeInitialMapEdit(InitialMapOf(world, {0}), world.Imaging(), Rigid3{}, KeyFrameId{0}),
      BugError);
}

}  // namespace
}  // namespace plumbline
