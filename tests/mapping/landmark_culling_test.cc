// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_culling.h"

#include "tests/map/map_fixture.h"
#include "tests/support/misfits.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const CleanupOptions kOptions{.redundant_share = 0.9, .revisited_share = 0.7};

MapPoint CreatedBy(std::int64_t keyframe, std::int64_t id, const Observations& observations) {
  MapPoint point = PointSeenBy(id, observations);
  point.created_by = KeyFrameId{keyframe};
  return point;
}

struct Verdict {
  bool removed = false;
  bool still_young = false;
};

// What becomes of a point and of a line with the same history when keyframe `newest` has come.
Verdict Judge(int visible, int found, std::int64_t newest, int views) {
  Map map = ChainOfKeyFrames(8);
  MapPoint point = CreatedBy(2, 0, SeenBy(2, 2 + views - 1, 0));
  MapLine line = LineSeenBy(0, SeenBy(2, 2 + views - 1, 0));
  line.created_by = KeyFrameId{2};
  map.Apply({edit::AddPoint{point},
             edit::AddLine{line},
             edit::ScorePoint{point.id, visible - 1, found - 1},
             edit::ScoreLine{line.id, visible - 1, found - 1}});
  LandmarkIds young{{point.id}, {line.id}};
  const MapEdit edit = RemoveWeakLandmarks(map, KeyFrameId{newest}, young);
  EXPECT_EQ(young.points.size(), young.lines.size());
  EXPECT_TRUE(edit.empty() || edit.size() == 2U);
  return {!edit.empty(), !young.points.empty()};
}

TEST(RemoveWeakLandmarks, GivesEachItsTrial) {
  Verdict v = Judge(4, 1, 3, 1);  // just good enough, still on trial
  EXPECT_FALSE(v.removed);
  EXPECT_TRUE(v.still_young);
  v = Judge(5, 1, 3, 1);  // seldom found
  EXPECT_TRUE(v.removed);
  EXPECT_FALSE(v.still_young);
  v = Judge(4, 4, 4, 1);  // two keyframes later
  EXPECT_FALSE(v.removed);
  EXPECT_TRUE(v.still_young);
  v = Judge(4, 4, 5, 1);  // trial over, nobody else shows it
  EXPECT_TRUE(v.removed);
  v = Judge(4, 4, 5, 2);  // passed
  EXPECT_FALSE(v.removed);
  EXPECT_FALSE(v.still_young);
}

TEST(RemoveWeakLandmarks, ForgetsWhatIsGoneAndLeavesTheOldAlone) {
  Map map = ChainOfKeyFrames(8);
  map.Apply(
      {edit::AddPoint{CreatedBy(0, 0, SeenBy(0, 0, 0))}, edit::ScorePoint{PointId{0}, 100, 0}});
  LandmarkIds young{{PointId{55}}, {LineId{55}}};
  EXPECT_TRUE(RemoveWeakLandmarks(map, KeyFrameId{7}, young).empty());
  EXPECT_TRUE(young.points.empty());
  EXPECT_TRUE(young.lines.empty());
}

// Keyframes 0 to 5; of the 40 landmarks of keyframe 2, `shared` are shown by all, the others by 2
// and 3 only.
Map Overlapping(int shared, int octave_of_others = 0) {
  Map map;
  for (std::int64_t k = 0; k < 6; ++k) {
    KeyFrame keyframe = BlankKeyFrame(k, k - 1);
    FrameFeatures indexed = *keyframe.frame.indexed;
    for (PointFeature& point : indexed.features.points)
      point.octave = static_cast<std::int16_t>(k == 2 ? 0 : octave_of_others);
    keyframe.frame.indexed = std::make_shared<const FrameFeatures>(std::move(indexed));
    map.Apply({edit::AddKeyFrame{keyframe}});
  }
  for (int i = 0; i < 20; ++i) {
    const bool point_shared = 2 * i < shared;
    const bool line_shared = 2 * i + 1 < shared;
    map.Apply({edit::AddPoint{PointSeenBy(i, point_shared ? SeenBy(0, 5, i) : SeenBy(2, 3, i))},
               edit::AddLine{LineSeenBy(i, line_shared ? SeenBy(0, 5, i) : SeenBy(2, 3, i))}});
  }
  map.CheckInvariants();
  return map;
}

std::vector<KeyFrameId> Removed(const Map& map,
                                std::int64_t centre,
                                const CleanupOptions& options) {
  std::vector<KeyFrameId> removed;
  for (const MapChange& change : RemoveRedundantKeyFrames(map, KeyFrameId{centre}, options)) {
    removed.push_back(std::get<edit::RemoveKeyFrame>(change).id);
  }
  return removed;
}

TEST(RemoveRedundantKeyFrames, TakesOutOneWhoseLandmarksOthersShow) {
  const Map map = Overlapping(40);
  const auto removed = Removed(map, 5, kOptions);
  ASSERT_EQ(removed.size(), 1U);
  EXPECT_GT(removed[0], KeyFrameId{0});  // the first,
  EXPECT_LT(removed[0], KeyFrameId{4});  // the one before the newest and the newest stay
}

TEST(RemoveRedundantKeyFrames, StopsWhenNoneIsLeftOver) {
  Map map = Overlapping(40);
  for (int i = 0; i < 6; ++i) {
    map.Apply(RemoveRedundantKeyFrames(map, KeyFrameId{5}, kOptions));
    map.CheckInvariants();
  }
  EXPECT_EQ(map.keyframes().size(), 3U);
  EXPECT_NE(map.Find(KeyFrameId{0}), nullptr);
  EXPECT_NE(map.Find(KeyFrameId{4}), nullptr);
  EXPECT_NE(map.Find(KeyFrameId{5}), nullptr);
}

TEST(RemoveRedundantKeyFrames, CountsTheShareOfLandmarks) {
  // Keyframe 1 shows only what all show and would go first; without it 3 is judged before 2.
  Map map = Overlapping(36);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}});
  EXPECT_EQ(Removed(map, 5, kOptions), std::vector<KeyFrameId>{{3}});  // 36 of 40
  Map less = Overlapping(35);
  less.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}});
  EXPECT_TRUE(Removed(less, 5, kOptions).empty());
  CleanupOptions never = kOptions;
  never.redundant_share = 1;
  EXPECT_TRUE(Removed(map, 5, never).empty());
}

TEST(RemoveRedundantKeyFrames, AFinerViewIsNotReplacedByCoarserOnes) {
  // Only keyframe 2 shows the points at the finest scale.
  Map map = Overlapping(40, 2);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}, edit::RemoveKeyFrame{KeyFrameId{3}}});
  EXPECT_TRUE(Removed(map, 5, kOptions).empty());
  Map near = Overlapping(40, 1);
  near.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}, edit::RemoveKeyFrame{KeyFrameId{3}}});
  EXPECT_EQ(Removed(near, 5, kOptions).size(), 1U);
}

// Keyframes 0 to 3 of one visit and 30 to 33 of another, with keyframes of elsewhere between. Of
// the 40 landmarks of keyframe 31, `again` are shown by all keyframes of both visits, the others by
// those of the second.
Map Revisited(int again) {
  Map map = ChainOfKeyFrames(34);
  for (int i = 0; i < 20; ++i) {
    const auto seen = [&](bool by_both) {
      Observations observations = SeenBy(30, 33, i);
      for (std::int64_t k = 0; by_both && k < 4; ++k) observations.emplace(KeyFrameId{k}, i);
      return observations;
    };
    map.Apply({edit::AddPoint{PointSeenBy(i, seen(2 * i < again))},
               edit::AddLine{LineSeenBy(i, seen(2 * i + 1 < again))}});
  }
  map.CheckInvariants();
  return map;
}

std::optional<KeyFrameId> RemovedAgain(const Map& map, const CleanupOptions& options = kOptions) {
  const MapEdit edit = RemoveRevisitedKeyFrames(map, KeyFrameId{33}, options);
  if (edit.empty()) return std::nullopt;
  return std::get<edit::RemoveKeyFrame>(edit.front()).id;
}

TEST(RemoveRevisitedKeyFrames, TakesOutWhatAnotherVisitShows) {
  EXPECT_EQ(RemovedAgain(Revisited(28)), KeyFrameId{31});  // 70 %; 32 came before the newest
  CleanupOptions never = kOptions;
  never.revisited_share = 1;
  EXPECT_EQ(RemovedAgain(Revisited(28), never), std::nullopt);
}

TEST(RemoveRevisitedKeyFrames, LeavesWhatOneVisitAloneShows) {
  Map map = Revisited(0);
  EXPECT_EQ(RemovedAgain(map), std::nullopt);
  // The keyframes of the second visit show 26 of 40, the others too little of what they show.
  map = Revisited(26);
  for (std::int64_t k = 0; k < 4; ++k) map.Apply({edit::RemoveKeyFrame{KeyFrameId{k}}});
  EXPECT_EQ(RemovedAgain(map), std::nullopt);
}

TEST(RemoveRevisitedKeyFrames, HoldsTheNumberOfKeyFramesThroughManyVisits) {
  Map map = Revisited(40);
  std::int64_t next = 34;
  std::size_t most = 0;
  for (int visit = 0; visit < 10; ++visit) {
    for (int k = 0; k < 4; ++k, ++next) {
      KeyFrame keyframe = BlankKeyFrame(next, next - 1);
      for (int i = 0; i < 20; ++i) {
        keyframe.frame.points[static_cast<std::size_t>(i)] = PointId{i};
        keyframe.frame.lines[static_cast<std::size_t>(i)] = LineId{i};
      }
      map.Apply({edit::AddKeyFrame{keyframe}});
      map.Apply(RemoveRedundantKeyFrames(map, KeyFrameId{next}, kOptions));
      map.Apply(RemoveRevisitedKeyFrames(map, KeyFrameId{next}, kOptions));
      map.CheckInvariants();
    }
    most = std::max(most, map.keyframes().size());
  }
  EXPECT_LE(most, 34U);
  // Every keyframe that ever was still has a place, one step from one that is in the map.
  for (const auto& [id, removed] : map.Record().removed_keyframes) {
    EXPECT_NE(map.Find(removed.parent), nullptr);
    EXPECT_NEAR(Inverse(map.PoseOf(id)).translation.x(), -static_cast<double>(id.value), 1e-9);
  }
}

TEST(RemoveRevisitedKeyFrames, LandmarksThatNobodyShowsGo) {
  Map map = Revisited(40);
  Observations by_two{{KeyFrameId{31}, 25}, {KeyFrameId{32}, 25}};
  MapPoint old = PointSeenBy(25, by_two), young = PointSeenBy(26, {});
  young.observations = {{KeyFrameId{31}, 26}, {KeyFrameId{32}, 26}};
  old.created_by = KeyFrameId{5};
  young.created_by = KeyFrameId{32};
  map.Apply({edit::AddPoint{old}, edit::AddPoint{young}});
  ASSERT_EQ(RemovedAgain(map), KeyFrameId{31});
  map.Apply(RemoveRevisitedKeyFrames(map, KeyFrameId{33}, kOptions));
  EXPECT_EQ(map.Find(PointId{25}), nullptr);
  EXPECT_NE(map.Find(PointId{26}), nullptr);
  map.CheckInvariants();
}

}  // namespace

namespace outlier_removal_test {

std::vector<Rigid3> TruePoses() {
  std::vector<Rigid3> poses;
  for (int k = 0; k < 8; ++k) poses.push_back(PoseOnPath(8 * k));
  return poses;
}

TrueMap SceneOf(const SyntheticWorld& world) {
  return MakeTrueMap(world, TruePoses(), {.noise = 0.3, .missed = 0});
}

void Clean(const SyntheticWorld& world, Map& map) {
  map.Apply(RemoveOutliers(map, world.Imaging(), {}));
  map.CheckInvariants();
}

using Wrong = std::pair<KeyFrameId, LineId>;

// Exchanges the observations of two lines in one keyframe in the middle of their tracks. Returns
// the observations that are wrong now.
std::set<Wrong> ExchangeLines(TrueMap& scene, KeyFrameId keyframe, LineId a, LineId b) {
  const int of_a = scene.map.Find(a)->observations.at(keyframe);
  const int of_b = scene.map.Find(b)->observations.at(keyframe);
  scene.map.Apply({edit::RemoveLineObservation{a, keyframe},
                   edit::RemoveLineObservation{b, keyframe},
                   edit::AddLineObservation{a, keyframe, of_b},
                   edit::AddLineObservation{b, keyframe, of_a}});
  return {{keyframe, a}, {keyframe, b}};
}

TEST(RemoveOutliers, ChangesNothingWhereAllAgree) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  const TrueMap scene = SceneOf(world);
  EXPECT_TRUE(RemoveOutliers(scene.map, world.Imaging(), {}).empty());
  EXPECT_TRUE(RemoveOutliers(Map(), world.Imaging(), {}).empty());
}

TEST(RemoveOutliers, TakesAwayWhatIsWrongInTheMiddleOfATrack) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  std::vector<LineId> long_seen;
  for (const auto& [id, line] : scene.map.lines()) {
    if (line.observations.size() == TruePoses().size()) long_seen.push_back(id);
  }
  ASSERT_GE(long_seen.size(), 10U);
  std::set<Wrong> wrong;
  for (std::size_t i = 0; i + 1 < long_seen.size(); i += 2) {
    wrong.merge(ExchangeLines(scene, KeyFrameId{4}, long_seen[i], long_seen[i + 1]));
  }
  const Map before = scene.map;
  ASSERT_GE(CountMisfits(before, world.camera).lines.beyond, static_cast<int>(wrong.size()));
  Clean(world, scene.map);
  EXPECT_EQ(CountMisfits(scene.map, world.camera).lines.beyond, 0);
  EXPECT_EQ(scene.map.lines().size(), before.lines().size());
  for (const auto& [id, line] : before.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      EXPECT_EQ(scene.map.Find(id)->observations.contains(keyframe),
                !wrong.contains({keyframe, id}))
          << id.value << " in " << keyframe.value;
    }
  }
}

// Nothing shows these landmarks where they are now: not the observations are wrong.
TEST(RemoveOutliers, FitsLandmarksThatKeyFramesLeftBehind) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  const Map before = scene.map;
  MapEdit edit;
  const Eigen::Vector3d shift(0.05, 0.05, 0.05);
  for (const auto& [id, point] : before.points()) {
    edit.push_back(edit::MovePoint{id, point.position + shift});
  }
  for (const auto& [id, line] : before.lines()) {
    const PluckerLine moved = Transform(Rigid3{Eigen::Quaterniond::Identity(), shift}, line.line);
    edit.push_back(edit::MoveLine{id, moved, line.start, line.end, line.information});
  }
  scene.map.Apply(edit);
  ASSERT_GT(CountMisfits(scene.map, world.camera).points.Share(), 0.5);
  ASSERT_GT(CountMisfits(scene.map, world.camera).lines.Share(), 0.5);
  Clean(world, scene.map);
  const Misfits after = CountMisfits(scene.map, world.camera);
  const Misfits truth = CountMisfits(before, world.camera);
  EXPECT_EQ(after.points.beyond + after.lines.beyond, 0);
  EXPECT_GE(after.points.all, 0.98 * truth.points.all);
  EXPECT_GE(after.lines.all, 0.95 * truth.lines.all);
}

TEST(RemoveOutliers, RemovesLandmarksThatTooFewKeyFramesShow) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 60);
  TrueMap scene = SceneOf(world);
  // Three keyframes show each of these points, one of them something else: the other two would
  // agree with some point nearly always.
  MapEdit edit;
  std::vector<PointId> broken;
  for (const auto& [id, point] : scene.map.points()) {
    if (point.observations.size() != TruePoses().size() || broken.size() == 10) continue;
    broken.push_back(id);
    for (const auto& [keyframe, feature] : point.observations) {
      if (keyframe.value > 2) edit.push_back(edit::RemovePointObservation{id, keyframe});
    }
  }
  ASSERT_EQ(broken.size(), 10U);
  Features features = scene.map.Find(KeyFrameId{0})->frame.features();
  for (const PointId id : broken) {
    const int feature = scene.map.Find(id)->observations.at(KeyFrameId{0});
    features.points[static_cast<std::size_t>(feature)].px.y() += 40;
  }
  edit.push_back(
      edit::MoveFeatures{KeyFrameId{0}, IndexFeatures(world.camera, std::move(features))});
  scene.map.Apply(edit);
  const std::size_t before = scene.map.points().size();
  Clean(world, scene.map);
  for (const PointId id : broken) EXPECT_EQ(scene.map.Find(id), nullptr) << id.value;
  EXPECT_EQ(scene.map.points().size(), before - broken.size());
}

}  // namespace outlier_removal_test

}  // namespace plumbline
