// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/combined_atlases.h"

#include "tests/map/map_fixture.h"
#include "tests/support/random_geometry.h"
#include "tests/support/true_map.h"
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

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

const SyntheticWorld& World() {
  static const SyntheticWorld world = MakeSyntheticWorld(80, 30);
  return world;
}

Map MapOf(const std::vector<int>& frames, std::uint64_t seed) {
  std::vector<Rigid3> poses;
  for (const int frame : frames) poses.push_back(PoseOnPath(frame));
  return MakeTrueMap(World(), poses, {}, seed).map;
}

const Similarity3 kMotion{1, ExpSo3({0.4, -0.9, 0.3}), {3, -1, 7}};
const Similarity3 kGrowth{2.5, ExpSo3({-0.4, 0.2, 1.3}), {-4, 2, 0.5}};

// The second behind the first, as part of it.
Map Together(const Map& first, const Map& second, const Similarity3& first_from_second) {
  Map together = first;
  together.Absorb(Renumbered(second, Behind(first)), first_from_second);
  return together;
}

// Where each observation of a map's landmarks projects to: pixels, and for lines the distances of
// both measured ends.
std::vector<double> Reprojections(const Map& map, const RectifiedCamera& camera) {
  std::vector<double> numbers;
  for (const auto& [id, point] : map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      const Eigen::Vector2d px =
          camera.Project(map.Find(keyframe)->frame.cam_from_world * point.position);
      numbers.insert(numbers.end(), {px.x(), px.y()});
    }
  }
  for (const auto& [id, line] : map.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      const Frame& frame = map.Find(keyframe)->frame;
      Eigen::Vector3d image =
          camera.ProjectMoment(Transform(frame.cam_from_world, line.line).moment);
      image /= image.head<2>().norm();
      const Segment2& segment = frame.features().lines[static_cast<std::size_t>(feature)].segment;
      numbers.push_back(LineDistance(image, segment.start));
      numbers.push_back(LineDistance(image, segment.end));
      for (const Eigen::Vector3d& end : {line.Interval().start, line.Interval().end}) {
        const Eigen::Vector2d px = camera.Project(frame.cam_from_world * end);
        numbers.insert(numbers.end(), {px.x(), px.y()});
      }
    }
  }
  return numbers;
}

// A camera that returns to a map goes on in it, with new ids, and may then find that the map which
// it left in between shows the same place.
TEST(Renumbered, AbsorbedComesBeforeWhatTheGrowingMapHas) {
  const Map left = MapOf({0, 2, 4}, 1);
  const Map growing = Renumbered(MapOf({1, 3, 5, 7}, 2), Behind(left));
  Map together = growing;
  together.Absorb(left, kMotion);
  for (const auto& [id, keyframe] : left.keyframes()) {
    EXPECT_EQ(together.NumberOf(id), keyframe.number);
  }
  for (const auto& [id, keyframe] : growing.keyframes()) {
    EXPECT_EQ(together.NumberOf(id), keyframe.number + left.Record().keyframes_taken_in);
  }
}

TEST(Renumbered, AbsorbedKeepsAllReprojectionsOfBoth) {
  const Map first = MapOf({0, 10, 20}, 1), second = MapOf({30, 40}, 2);
  ASSERT_GT(second.lines().size(), 5U);
  for (const Similarity3& motion : {kMotion, kGrowth}) {
    const Map merged = Together(first, second, motion);
    merged.CheckInvariants();
    std::vector<double> before = Reprojections(first, World().camera);
    const std::vector<double> points = Reprojections(second, World().camera);
    before.insert(before.end(), points.begin(), points.end());
    std::vector<double> after = Reprojections(merged, World().camera);
    // Points come before lines in both lists.
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-6);
  }
}

TEST(Renumbered, StandsBehindAnotherMap) {
  Map first = MapOf({0, 10, 20}, 1);
  const Map second = MapOf({30, 40}, 2);
  first.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}});
  const Map merged = Together(first, second, kMotion);
  EXPECT_EQ(merged.keyframes().size(), first.keyframes().size() + 2);
  EXPECT_EQ(merged.points().size(), first.points().size() + second.points().size());
  EXPECT_EQ(merged.lines().size(), first.lines().size() + second.lines().size());
  for (const auto& [id, keyframe] : first.keyframes()) {
    EXPECT_EQ(merged.Find(id)->frame.points, keyframe.frame.points);
    EXPECT_EQ(merged.Find(id)->frame.cam_from_world.Matrix(),
              keyframe.frame.cam_from_world.Matrix());
  }
  EXPECT_FALSE(merged.Find(KeyFrameId{3})->parent.valid());
  EXPECT_EQ(merged.Find(KeyFrameId{4})->parent, KeyFrameId{3});
  const std::int64_t next = first.NextPointId().value;
  for (const auto& [id, point] : second.points()) {
    const MapPoint* moved = merged.Find(PointId{id.value + next});
    ASSERT_NE(moved, nullptr);
    EXPECT_EQ(moved->descriptor, point.descriptor);
    EXPECT_EQ(moved->created_by.value, point.created_by.value + 3);
    EXPECT_EQ(moved->observations.size(), point.observations.size());
    EXPECT_LT((moved->position - kMotion * point.position).norm(), 1e-12);
  }
}

// What RefreshPoint and RefreshLine make of the moved keyframes is what has been moved.
TEST(Renumbered, AbsorbedHasAppearancesAsObservationsTell) {
  const Map second = MapOf({30, 40}, 2);
  for (const Similarity3& motion : {kMotion, kGrowth}) {
    const Map merged = Together(Map(), second, motion);
    Map refreshed = merged;
    for (const auto& [id, point] : merged.points()) {
      refreshed.Apply({edit::RefreshPoint{id}});
      EXPECT_LT((refreshed.Find(id)->view_direction - point.view_direction).norm(), 1e-9);
      EXPECT_NEAR(refreshed.Find(id)->reference_distance, point.reference_distance, 1e-9);
    }
    for (const auto& [id, line] : merged.lines()) {
      refreshed.Apply({edit::RefreshLine{id}});
      EXPECT_LT((refreshed.Find(id)->view_direction - line.view_direction).norm(), 1e-9);
    }
  }
}

// The information of a line that was measured by keyframes is what they give in the new world, too.
TEST(Renumbered, AbsorbedHasInformationAsMeasurementsTell) {
  const Map second = MapOf({30, 33, 36, 40}, 2);
  for (const Similarity3& motion : {kMotion, kGrowth}) {
    const Map merged = Together(Map(), second, motion);
    RectifiedCamera camera = World().camera;
    camera.baseline *= motion.scale;  // so that the right image stays what it was
    for (const auto& [id, line] : merged.lines()) {
      Eigen::Matrix4d measured = Eigen::Matrix4d::Zero();
      for (const auto& [keyframe, feature] : line.observations) {
        measured += LineInformation(
            camera, merged.Find(keyframe)->frame, static_cast<std::size_t>(feature), line.line);
      }
      EXPECT_LT((measured - line.information).norm(), 1e-6 * measured.norm()) << id.value;
    }
  }
}

TEST(Renumbered, OfAnEmptyMapAddsNothing) {
  const Map first = MapOf({0, 10}, 1);
  const Map merged = Together(first, Map(), kMotion);
  merged.CheckInvariants();
  EXPECT_EQ(merged.points().size(), first.points().size());
  EXPECT_EQ(Together(Map(), first, {}).lines().size(), first.lines().size());
}

TEST(Renumbered, KnowsWhatWasRemovedOrMerged) {
  Map map = MapOf({0, 10, 20}, 1);
  const PointId gone = map.points().begin()->first;
  const PointId kept = std::next(map.points().begin())->first;
  map.Apply({edit::MergePoints{kept, gone}, edit::RemoveKeyFrame{KeyFrameId{1}}});
  const IdOffsets offsets{3, 100, 1000, 2000, {SessionId{4}}};
  const Map renumbered = Renumbered(map, offsets);
  renumbered.CheckInvariants();
  EXPECT_EQ(renumbered.id(), MapId{3});
  EXPECT_EQ(renumbered.Current(offsets(gone)), offsets(map.Current(gone)));
  EXPECT_FALSE(renumbered.Knows(KeyFrameId{1}));
  EXPECT_TRUE(renumbered.Knows(KeyFrameId{101}));
  EXPECT_EQ(renumbered.PoseOf(KeyFrameId{101}).Matrix(), map.PoseOf(KeyFrameId{1}).Matrix());
  EXPECT_EQ(renumbered.NumberOf(KeyFrameId{102}), map.NumberOf(KeyFrameId{2}));
  EXPECT_EQ(renumbered.Find(KeyFrameId{102})->session, SessionId{4});
  EXPECT_EQ(renumbered.NextLineId(), LineId{map.NextLineId().value + 2000});
}

}  // namespace

}  // namespace plumbline
