// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/map_merge.h"

#include "plumbline/geometry/alignment.h"
#include "plumbline/map/combined_atlases.h"

#include "tests/loop_closing/loop_scene.h"
#include "tests/support/synthetic_run.h"
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::LoopSceneOptions;

constexpr int kRound = 300;  // frames

Rigid3 PoseAt(int frame) {
  return testing::loop_scene_detail::PoseOnCircle(2 * std::numbers::pi * frame / kRound);
}

SlamOptions WithoutLoops() {
  SlamOptions options = SyntheticRun::InlineOptions();
  options.loop.enabled = false;
  return options;
}

// The map of a run over some frames of the way round.
SavedAtlas MapOfFrames(const SyntheticWorld& world, int begin, int end) {
  SyntheticRun run(world, WithoutLoops());
  for (int k = begin; k < end; ++k) run.Step(PoseAt(k), {});
  run.Finish();
  SavedAtlas saved;
  saved.atlas = run.mapping().atlas();
  return saved;
}

SavedAtlas AtlasOf(Map map) {
  SavedAtlas saved;
  const MapId id = map.id();
  saved.atlas.Adopt(std::move(map));
  saved.atlas.Activate(id);
  return saved;
}

Expected<MergedMaps, MergeRefusal> Merged(const SavedAtlas& first,
                                          const SavedAtlas& second,
                                          const CameraAndPyramid& imaging) {
  const CombinedAtlases gathered = CombineAtlases(first, second);
  const Atlas& atlas = gathered.saved.atlas;
  return MergeMaps(atlas, atlas.active_id(), gathered.second, imaging, WithoutLoops());
}

// The absolute trajectory error of the keyframes, of which `true_pose` tells cam_from_world [m].
template <class TruePose>
double AteOf(const Map& map, AlignmentScale scale, const TruePose& true_pose) {
  std::vector<Eigen::Vector3d> found, is;
  for (const auto& [id, keyframe] : map.keyframes()) {
    found.push_back(Inverse(keyframe.frame.cam_from_world).translation);
    is.push_back(Inverse(true_pose(keyframe)).translation);
  }
  return AlignPoints(found, is, scale)->rmse;
}

// Points that keyframes of both maps show.
std::size_t SharedPoints(const Map& map, KeyFrameId first_of_second) {
  std::size_t shared = 0;
  for (const auto& [id, point] : map.points()) {
    const bool by_first = point.observations.begin()->first < first_of_second;
    shared += by_first && !(point.observations.newest().first < first_of_second);
  }
  return shared;
}

TEST(MergeMaps, MakesOneMapOfTwoHalvesThatOverlap) {
  const SyntheticWorld world = testing::loop_scene_detail::MakeWorld({});
  constexpr int kSecondBegins = 130;
  const SavedAtlas first = MapOfFrames(world, 0, 190);
  const SavedAtlas second = MapOfFrames(world, kSecondBegins, 290);
  const auto merged = Merged(first, second, world.Imaging());
  ASSERT_TRUE(merged) << static_cast<int>(merged.error());
  EXPECT_GE(merged->overlap.size(), 4U);
  EXPECT_GE(merged->ties, 4);
  ASSERT_EQ(merged->atlas.maps().size(), 1U);
  const Map& map = merged->atlas.active();
  map.CheckInvariants();
  EXPECT_EQ(map.id(), first.atlas.active_id());
  const KeyFrameId first_of_second = first.atlas.NextKeyFrameId();
  EXPECT_EQ(map.keyframes().size(),
            first.atlas.active().keyframes().size() + second.atlas.active().keyframes().size());
  EXPECT_GT(SharedPoints(map, first_of_second), 100U);
  // The oldest keyframe keeps the world.
  const KeyFrameId oldest = map.keyframes().begin()->first;
  EXPECT_EQ(map.PoseOf(oldest).translation, first.atlas.active().PoseOf(oldest).translation);
  const auto true_pose = [&](const KeyFrame& keyframe) {
    const bool of_second = !(keyframe.id < first_of_second);
    return PoseAt(static_cast<int>(keyframe.frame.id.value) + (of_second ? kSecondBegins : 0));
  };
  EXPECT_LT(AteOf(map, AlignmentScale::kFixed, true_pose), 0.02);
}

// A map of one camera that drifted, in a world and a unit of its own.
TEST(MergeMaps, FindsTheUnitOfAnotherMapOfOneCamera) {
  LoopSceneOptions options;
  options.sensor.depth = false;
  options.keyframes = 30;
  const testing::LoopScene first = testing::MakeLoopScene(options);
  const Similarity3 moved{0.4, ExpSo3({0.2, 1.1, -0.3}), {5, -2, 9}};
  options.drift = [&](int keyframe) { return moved * testing::ShrinkingDrift(keyframe); };
  const testing::LoopScene second = testing::MakeLoopScene(options);
  const auto merged = Merged(AtlasOf(first.map), AtlasOf(second.map), first.Imaging());
  ASSERT_TRUE(merged) << static_cast<int>(merged.error());
  const Map& map = merged->atlas.active();
  map.CheckInvariants();
  const auto true_pose = [&](const KeyFrame& keyframe) {
    return first.truth[static_cast<std::size_t>(keyframe.frame.id.value)];
  };
  // The first map alone has 0.03 m after the adjustment: so much does noise bend it.
  EXPECT_LT(AteOf(map, AlignmentScale::kFree, true_pose), 0.04);
  EXPECT_LT(AteOf(map, AlignmentScale::kFixed, true_pose), 0.12);
  EXPECT_GT(merged->first_from_second.scale, 2);
}

TEST(MergeMaps, RefusesMapsOfDifferentPlaces) {
  const SyntheticWorld world = testing::loop_scene_detail::MakeWorld({});
  const auto merged =
      Merged(MapOfFrames(world, 0, 60), MapOfFrames(world, 150, 210), world.Imaging());
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error(), MergeRefusal::kNoOverlap);
}

// The second map may be of either half of the way round.
TEST(MergeMaps, RefusesToChooseBetweenPlacesThatLookAlike) {
  LoopSceneOptions options;
  options.alike_sectors = 2;
  options.keyframes = 38;
  const testing::LoopScene first = testing::MakeLoopScene(options);
  options.keyframes = 8;
  const testing::LoopScene second = testing::MakeLoopScene(options);
  const auto merged = Merged(AtlasOf(first.map), AtlasOf(second.map), first.Imaging());
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error(), MergeRefusal::kAmbiguous);
}

TEST(MergeMaps, RefusesMapsOfOneKeyFrame) {
  LoopSceneOptions options;
  options.keyframes = 1;
  const testing::LoopScene scene = testing::MakeLoopScene(options);
  const auto merged = Merged(AtlasOf(scene.map), AtlasOf(scene.map), scene.Imaging());
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error(), MergeRefusal::kNoOverlap);
}

}  // namespace
}  // namespace plumbline
