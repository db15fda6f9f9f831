// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/whole_map_adjustment.h"

#include "plumbline/mapping/landmark_culling.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/mapping/local_mapper.h"

#include "tests/mapping/vertical_lines.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace whole_map_adjustment_test {

constexpr int kKeyFrames = 10;

std::vector<Rigid3> TruePoses() {
  std::vector<Rigid3> poses;
  for (int k = 0; k < kKeyFrames; ++k) poses.push_back(PoseOnPath(8 * k));
  return poses;
}

// A true map, then all keyframes but the first out of place, with what they show left behind.
TrueMap MovedMap(const SyntheticWorld& world) {
  TrueMap scene = MakeTrueMap(world, TruePoses(), {.noise = 0.1});
  Rng rng(5, "moved_map");
  MapEdit edit;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    Vector6d twist;
    twist << RandomVector<3>(rng, 0.0005), RandomVector<3>(rng, 0.003);
    if (id == KeyFrameId{0}) twist.setZero();
    edit.push_back(edit::SetPose{id, ExpSe3(twist) * keyframe.frame.cam_from_world});
  }
  scene.map.Apply(edit);
  return scene;
}

TEST(AdjustWholeMap, BringsKeyFramesToTheirPlaces) {
  const SyntheticWorld world = MakeSyntheticWorld(150, 100);
  TrueMap scene = MovedMap(world);
  const double before = WorstPose(scene.map, TruePoses());
  ASSERT_GT(before, 0.004);
  scene.map.Apply(RebaseCorrection(AdjustWholeMap(scene.map, world.Imaging(), {}, {}), scene.map));
  scene.map.CheckInvariants();
  EXPECT_LT(WorstPose(scene.map, TruePoses()), 0.4 * before);
  EXPECT_LT(CentreDistance(scene.map.Find(KeyFrameId{0})->frame.cam_from_world, PoseOnPath(0)),
            1e-9);
}

// A true map of one camera that turns, whose features are displaced by what a lens correction of
// `border_px` would take away.
TrueMap MapThroughALens(SyntheticWorld& world, double border_px) {
  world.camera.baseline = 0;
  TrueMap scene = MakeTrueMap(world, TruePoses(), {.depth = false, .noise = 0.1});
  const FeatureCorrection lens{{}, {world.camera, border_px}};
  MapEdit edit;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    Features displaced = keyframe.frame.features();
    Correct(lens, {}, displaced);
    edit.push_back(edit::MoveFeatures{id, IndexFeatures(world.camera, std::move(displaced))});
  }
  scene.map.Apply(edit);
  return scene;
}

TEST(AdjustWholeMap, LearnsWhatIsLeftOfTheLens) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 12);
  const MapCorrection learned = AdjustWholeMap(scene.map, world.Imaging(), {}, {});
  ASSERT_TRUE(learned.lens);
  EXPECT_NEAR(learned.lens->border_px(), 12, 3);
  MappingOptions fixed;
  fixed.lens_calibration = false;
  EXPECT_FALSE(AdjustWholeMap(scene.map, world.Imaging(), {}, fixed).lens);

  scene.map.Apply(RebaseCorrection(learned, scene.map));
  EXPECT_EQ(scene.map.correction().lens, *learned.lens);
  EXPECT_FALSE(AdjustWholeMap(scene.map, world.Imaging(), {}, {}).lens);
  EXPECT_LT(WorstPose(scene.map, TruePoses()), 0.02);
}

TEST(AdjustWholeMap, LetsItsCallerShareTheFeaturesOfANewLens) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 12);
  const MapCorrection alone = AdjustWholeMap(scene.map, world.Imaging(), {}, {});
  ASSERT_TRUE(alone.lens);
  int told = 0;
  AdjustmentProgress progress;
  progress.on_lens = [&](const LensCorrection& lens) {
    ++told;
    EXPECT_EQ(lens, *alone.lens);
    scene.map.Apply({edit::CorrectFeatures{{{}, lens}}});
  };
  const MapCorrection shared = AdjustWholeMap(scene.map, world.Imaging(), {}, {}, {}, &progress);
  EXPECT_EQ(told, 1);
  EXPECT_EQ(shared.lens, alone.lens);
  ASSERT_EQ(shared.keyframes.size(), alone.keyframes.size());
  for (const auto& [id, place] : shared.keyframes) {
    EXPECT_EQ(place.after.translation, alone.keyframes.at(id).after.translation);
  }
  ASSERT_EQ(shared.points.size(), alone.points.size());
  for (const auto& [id, place] : shared.points) {
    EXPECT_EQ(place.after, alone.points.at(id).after);
  }
}

TEST(AdjustWholeMap, StoppedAtANewLensLeavesTheFeaturesOfAFinishedMap) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 12);
  const Map before = scene.map;
  bool learned = false;
  const LocalMapper mapper(world.Imaging(), {}, {});
  mapper.Finish(scene.map, [&] {
    learned = learned || !(scene.map.correction() == before.correction());
    return learned;
  });
  EXPECT_TRUE(learned);
  EXPECT_EQ(scene.map.correction(), before.correction());
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    const Frame& earlier = before.Find(id)->frame;
    EXPECT_EQ(keyframe.frame.cam_from_world.translation, earlier.cam_from_world.translation);
    for (std::size_t i = 0; i < earlier.points.size(); ++i) {
      const PointFeature& point = keyframe.frame.features().points[i];
      EXPECT_EQ(point.px, earlier.features().points[i].px);
      EXPECT_EQ(point.sigma_px, earlier.features().points[i].sigma_px);
    }
  }
}

// The map was adjusted with a wrong lens, so that its lines are bent as its keyframes are.
TEST(AdjustWholeMap, StraightensAMapOfAWrongLens) {
  const auto error = [](int lines) {
    SyntheticWorld world = MakeSyntheticWorld(600, lines);
    TrueMap scene = MapThroughALens(world, 12);
    const auto adjust = [&](bool lens) {
      MappingOptions options;
      options.lens_calibration = lens;
      const auto correction = AdjustWholeMap(scene.map, world.Imaging(), {}, options);
      for (const auto& [id, place] : correction.keyframes) {
        EXPECT_EQ(place.before.translation, scene.map.PoseOf(id).translation);
      }
      for (const auto& [id, place] : correction.points) {
        EXPECT_EQ(place.before, scene.map.Find(id)->position);
      }
      scene.map.Apply(RebaseCorrection(correction, scene.map));
    };
    adjust(false);
    scene.map.Apply(RemoveOutliers(scene.map, world.Imaging(), {}));
    EXPECT_GT(WorstPose(scene.map, TruePoses()), 0.05) << lines;
    adjust(true);
    return WorstPose(scene.map, TruePoses());
  };
  EXPECT_LT(error(0), 0.005);
  EXPECT_LT(error(100), 0.005);
}

TEST(AdjustToLens, LeavesTheNewestKeyFrameInItsPlace) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 12);
  const Rigid3 before = scene.map.keyframes().rbegin()->second.frame.cam_from_world;
  const MapCorrection learned =
      AdjustToLens(scene.map, world.Imaging(), LineOptions().weights(), {});
  ASSERT_TRUE(learned.lens);
  EXPECT_NEAR(learned.lens->border_px(), 12, 3);
  const auto& [newest, place] = *learned.keyframes.rbegin();
  EXPECT_LT(LogSe3(place.after * Inverse(before)).norm(), 1e-9);
  EXPECT_NEAR(place.scale, 1, 1e-9);
  scene.map.Apply(RebaseCorrection(learned, scene.map));
  scene.map.CheckInvariants();
  EXPECT_TRUE(AdjustToLens(scene.map, world.Imaging(), LineOptions().weights(), {}).empty());
}

TEST(AdjustToLens, TakesBackWhatThePointsContradict) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 0);
  scene.map.Apply({edit::CorrectFeatures{{{}, {world.camera, 4}}}});
  const MapCorrection learned =
      AdjustToLens(scene.map, world.Imaging(), LineOptions().weights(), {});
  ASSERT_TRUE(learned.lens);
  EXPECT_EQ(*learned.lens, LensCorrection());
}

TEST(BringToLens, AdjustsAMapToTheLensOfAnother) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  TrueMap scene = MapThroughALens(world, 6);
  const LensCorrection lens(world.camera, 6);
  const auto bring = [&] {
    return BringToLens(scene.map, world.Imaging(), LineOptions().weights(), {}, lens);
  };
  const MapCorrection correction = bring();
  ASSERT_TRUE(correction.lens);
  EXPECT_EQ(*correction.lens, lens);
  const Rigid3 newest = scene.map.keyframes().rbegin()->second.frame.cam_from_world;
  EXPECT_LT(LogSe3(correction.keyframes.rbegin()->second.after * Inverse(newest)).norm(), 1e-9);
  scene.map.Apply(RebaseCorrection(correction, scene.map));
  EXPECT_TRUE(bring().empty()) << "it has that lens";
  double worst = 0;
  for (const auto& [id, point] : scene.map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      const Frame& frame = scene.map.Find(keyframe)->frame;
      const Eigen::Vector2d px = frame.features().points[static_cast<std::size_t>(feature)].px;
      const Eigen::Vector2d seen = world.camera.Project(frame.cam_from_world * point.position);
      worst = std::max(worst, (px - seen).norm());
    }
  }
  EXPECT_LT(worst, 2);
}

TEST(AdjustToLens, ChangesNothingWhereNothingIsLearned) {
  SyntheticWorld world = MakeSyntheticWorld(600, 0);
  EXPECT_TRUE(
      AdjustToLens(MapThroughALens(world, 0).map, world.Imaging(), LineOptions().weights(), {})
          .empty());
  const TrueMap scene = MapThroughALens(world, 12);
  int asked = 0;
  const StopCheck soon = [&] { return asked++ >= 30; };
  EXPECT_TRUE(AdjustToLens(scene.map, world.Imaging(), LineOptions().weights(), {}, soon).empty());
  EXPECT_TRUE(AdjustToLens(Map(), world.Imaging(), LineOptions().weights(), {}).empty());
}

TEST(AdjustWholeMap, ChangesNothingWhenItIsStopped) {
  const SyntheticWorld world = MakeSyntheticWorld(150, 30);
  const TrueMap scene = MovedMap(world);
  int questions = 0;
  const MapCorrection whole =
      AdjustWholeMap(scene.map, world.Imaging(), {}, {}, [&] { return ++questions < 0; });
  EXPECT_FALSE(whole.empty());
  EXPECT_GT(questions, 10) << "before every line and every iteration";
  for (const int until : {0, 1, questions / 2, questions - 2}) {
    int asked = 0;
    EXPECT_TRUE(AdjustWholeMap(scene.map, world.Imaging(), {}, {}, [&] { return asked++ >= until; })
                    .empty())
        << until;
  }
}

TEST(AdjustWholeMap, NeedsNoPoints) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 150);
  TrueMap scene = MovedMap(world);
  const double before = WorstPose(scene.map, TruePoses());
  scene.map.Apply(RebaseCorrection(AdjustWholeMap(scene.map, world.Imaging(), {}, {}), scene.map));
  EXPECT_LT(WorstPose(scene.map, TruePoses()), 0.7 * before);
}

// Parallel lines leave one direction of each keyframe open.
TEST(AdjustWholeMap, LeavesKeyFramesInTheirPlacesThatNothingFixes) {
  const SyntheticWorld world = WorldOfVerticalLines(0, 150);
  TrueMap scene = MovedMap(world);
  const Map before = scene.map;
  ASSERT_FALSE(MakeLineMap(before, world.Imaging(), {}).empty());
  scene.map.Apply(RebaseCorrection(AdjustWholeMap(scene.map, world.Imaging(), {}, {}), scene.map));
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    const Rigid3& old = before.Find(id)->frame.cam_from_world;
    EXPECT_LT(LogSe3(keyframe.frame.cam_from_world * Inverse(old)).norm(), 1e-9) << id.value;
  }
}

// Points fix each half of the keyframes by itself; only vertical lines tie one to the other.
TEST(AdjustWholeMap, KeepsHalvesTogetherThatParallelLinesTie) {
  const SyntheticWorld world = WorldOfVerticalLines(150, 100);
  TrueMap scene = MovedMap(world);
  MapEdit edit;
  for (const auto& [id, point] : scene.map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      if ((keyframe.value < kKeyFrames / 2) != (id.value % 2 == 0)) {
        edit.push_back(edit::RemovePointObservation{id, keyframe});
      }
    }
  }
  scene.map.Apply(edit);
  const Map before = scene.map;
  scene.map.Apply(RebaseCorrection(AdjustWholeMap(scene.map, world.Imaging(), {}, {}), scene.map));
  const auto motion = [](const Map& map) {
    return map.Find(KeyFrameId{5})->frame.cam_from_world *
           Inverse(map.Find(KeyFrameId{4})->frame.cam_from_world);
  };
  EXPECT_LT(LogSe3(motion(scene.map) * Inverse(motion(before))).norm(), 0.02);
}

TEST(AdjustWholeMap, MovesALineLandmarkWithTheNewestKeyFrameThatShowsIt) {
  const SyntheticWorld world = MakeSyntheticWorld(150, 100);
  TrueMap scene = MovedMap(world);
  const Map before = scene.map;
  scene.map.Apply(RebaseCorrection(AdjustWholeMap(scene.map, world.Imaging(), {}, {}), scene.map));
  for (const auto& [id, line] : scene.map.lines()) {
    const MapLine& old = *before.Find(id);
    const KeyFrameId newest = line.observations.newest().first;
    const Rigid3& now = scene.map.Find(newest)->frame.cam_from_world;
    const Rigid3& then = before.Find(newest)->frame.cam_from_world;
    EXPECT_LT((now * line.Interval().start - then * old.Interval().start).norm(), 1e-9);
    EXPECT_LT((now * line.Interval().end - then * old.Interval().end).norm(), 1e-9);
  }
}

TEST(AdjustWholeMap, LeavesMapsAloneThatAreTooLargeOrTooSmall) {
  const SyntheticWorld world = MakeSyntheticWorld(50, 20);
  const TrueMap scene = MovedMap(world);
  MappingOptions options;
  for (const int keyframes : {0, kKeyFrames - 1}) {
    options.final_adjustment_keyframes = keyframes;
    EXPECT_TRUE(AdjustWholeMap(scene.map, world.Imaging(), {}, options).empty());
  }
  options.final_adjustment_keyframes = kKeyFrames;
  EXPECT_FALSE(AdjustWholeMap(scene.map, world.Imaging(), {}, options).empty());
  const TrueMap pair = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(8)}, {});
  EXPECT_TRUE(AdjustWholeMap(pair.map, world.Imaging(), {}, {}).empty());
}

// Each point is left to four keyframes that follow each other.
void ForgetAfterFourKeyFrames(TrueMap& scene) {
  MapEdit edit;
  for (const auto& [index, id] : scene.point_of) {
    const auto first = static_cast<std::int64_t>(index % (kKeyFrames - 3));
    for (const auto& [keyframe, feature] : scene.map.Find(id)->observations) {
      if (keyframe.value >= first && keyframe.value < first + 4) continue;
      edit.push_back(edit::RemovePointObservation{id, keyframe});
    }
  }
  scene.map.Apply(edit);
}

// Adjusts the map and takes the correction over.
void ExpectAdjustedPosesToBeBetter(const SyntheticWorld& world,
                                   const MappingOptions& options,
                                   TrueMap& scene) {
  const MapCorrection correction = AdjustWholeMap(scene.map, world.Imaging(), {}, options);
  ASSERT_FALSE(correction.empty());
  const double before = WorstPose(scene.map, TruePoses());
  scene.map.Apply(RebaseCorrection(correction, scene.map));
  EXPECT_LT(WorstPose(scene.map, TruePoses()), 0.8 * before);
}

// What counts is the time it takes, which is less where keyframes share landmarks with those near
// them only.
TEST(AdjustWholeMap, TakesLongPathsForTheSmallerMapsThatTakeAsLong) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 0);
  MappingOptions options;
  options.final_adjustment_keyframes = 7;
  TrueMap scene = MovedMap(world);
  EXPECT_TRUE(AdjustWholeMap(scene.map, world.Imaging(), {}, options).empty());
  ForgetAfterFourKeyFrames(scene);
  ExpectAdjustedPosesToBeBetter(world, options, scene);
  options.final_adjustment_keyframes = 4;
  EXPECT_TRUE(AdjustWholeMap(scene.map, world.Imaging(), {}, options).empty());
}

// All keyframes show the lines, so that with them each keyframe is tied to every other one.
TEST(AdjustWholeMap, LeavesOutLinesThatMakeItTakeTooLong) {
  const SyntheticWorld world = MakeSyntheticWorld(400, 40);
  MappingOptions options;
  options.final_adjustment_keyframes = 7;
  TrueMap scene = MovedMap(world);
  ForgetAfterFourKeyFrames(scene);
  ExpectAdjustedPosesToBeBetter(world, options, scene);
}

}  // namespace whole_map_adjustment_test
}  // namespace plumbline
