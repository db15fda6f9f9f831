// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/fusion.h"

#include "tests/support/true_map.h"
#include <variant>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr KeyFrameId kFirst{0}, kSecond{1};
const SensorModel kSensor{.noise = 0.5, .missed = 0};

// Two keyframes of one world. In the second each landmark has been forgotten, so that its features
// are free; `doubled` gives each of them a landmark of its own instead.
TrueMap TwoViews(const SyntheticWorld& world, bool doubled) {
  TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(6)}, kSensor);
  MapEdit edit;
  for (const auto& [id, point] : scene.map.points()) {
    if (point.observations.size() == 2) edit.push_back(edit::RemovePointObservation{id, kSecond});
  }
  for (const auto& [id, line] : scene.map.lines()) {
    if (line.observations.size() == 2) edit.push_back(edit::RemoveLineObservation{id, kSecond});
  }
  std::int64_t next_point = scene.map.NextPointId().value;
  std::int64_t next_line = scene.map.NextLineId().value;
  if (doubled) {
    for (const auto& [id, point] : scene.map.points()) {
      if (point.observations.size() < 2) continue;
      MapPoint copy = point;
      copy.id = PointId{next_point++};
      copy.observations.erase(kFirst);
      edit.push_back(edit::AddPoint{copy});
    }
    for (const auto& [id, line] : scene.map.lines()) {
      if (line.observations.size() < 2) continue;
      MapLine copy = line;
      copy.id = LineId{next_line++};
      copy.observations.erase(kFirst);
      edit.push_back(edit::AddLine{copy});
    }
  }
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  return scene;
}

MapEdit Fuse(const TrueMap& scene, const SyntheticWorld& world, KeyFrameId from, KeyFrameId to) {
  return FusionInto(scene.map, world.Imaging(), to).Fuse(from);
}

// Landmarks of the first view that the second shows as well.
std::pair<int, int> CommonlyVisible(const TrueMap& scene) {
  const auto common = [](const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
    std::vector<std::size_t> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return static_cast<int>(both.size());
  };
  return {common(scene.sensed[0].point_truth, scene.sensed[1].point_truth),
          common(scene.sensed[0].line_truth, scene.sensed[1].line_truth)};
}

TEST(FusionInto, AddsObservationsWhereThereIsNoLandmark) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene = TwoViews(world, false);
  const auto [points, lines] = CommonlyVisible(scene);
  const MapEdit edit = Fuse(scene, world, kFirst, kSecond);
  int new_points = 0;
  int new_lines = 0;
  for (const MapChange& change : edit) {
    if (const auto* p = std::get_if<edit::AddPointObservation>(&change)) {
      ++new_points;
      EXPECT_EQ(p->keyframe, kSecond);
      const std::size_t truth = scene.sensed[1].point_truth[static_cast<std::size_t>(p->feature)];
      EXPECT_EQ(scene.point_of.at(truth), p->id);
    } else if (const auto* l = std::get_if<edit::AddLineObservation>(&change)) {
      ++new_lines;
      const std::size_t truth = scene.sensed[1].line_truth[static_cast<std::size_t>(l->feature)];
      EXPECT_EQ(scene.line_of.at(truth), l->id);
    } else {
      ADD_FAILURE() << "neither a point nor a line observation";
    }
  }
  EXPECT_GT(new_points, points * 9 / 10);
  EXPECT_GT(new_lines, lines * 8 / 10);
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  EXPECT_TRUE(Fuse(scene, world, kFirst, kSecond).size() < edit.size() / 5);
}

TEST(FusionInto, MergesDoubles) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene = TwoViews(world, true);
  const std::size_t before = scene.map.points().size();
  const auto [points, lines] = CommonlyVisible(scene);
  const MapEdit edit = Fuse(scene, world, kFirst, kSecond);
  int merged_points = 0;
  int merged_lines = 0;
  for (const MapChange& change : edit) {
    if (const auto* p = std::get_if<edit::MergePoints>(&change)) {
      ++merged_points;
      EXPECT_LT(p->kept, p->gone);  // equally often seen: the older one stays
      EXPECT_EQ(scene.map.Find(p->kept)->position, scene.map.Find(p->gone)->position);
    } else if (std::holds_alternative<edit::MergeLines>(change)) {
      ++merged_lines;
    }
  }
  EXPECT_GT(merged_points, points * 9 / 10);
  EXPECT_GT(merged_lines, lines * 8 / 10);
  scene.map.Apply(edit);
  scene.map.CheckInvariants();
  EXPECT_EQ(scene.map.points().size(), before - static_cast<std::size_t>(merged_points));
}

TEST(FusionInto, KeepsTheOneSeenMoreOften) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 0);
  TrueMap scene = TwoViews(world, true);
  // A third keyframe shows the copies (the higher ids) once more.
  const KeyFrameId third = AddKeyFrameTo(scene.map, PoseOnPath(6), scene.sensed[1]);
  MapEdit more;
  for (const auto& [id, point] : scene.map.points()) {
    const auto seen = point.observations.find(kSecond);
    if (seen != point.observations.end()) {
      more.push_back(edit::AddPointObservation{id, third, seen->second});
    }
  }
  scene.map.Apply(more);
  int merges = 0;
  for (const MapChange& change : Fuse(scene, world, kFirst, kSecond)) {
    const auto* merge = std::get_if<edit::MergePoints>(&change);
    if (merge == nullptr) continue;
    ++merges;
    EXPECT_GT(merge->kept, merge->gone);
  }
  EXPECT_GT(merges, 50);
}

TEST(FusionInto, LeavesOutWhatDoesNotReproject) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 0);
  TrueMap scene = TwoViews(world, false);
  // All points half as far again: still near their features in a close view, but with disparities
  // that do not fit.
  MapEdit away;
  for (const auto& [id, point] : scene.map.points()) {
    away.push_back(edit::MovePoint{id, 1.5 * point.position});
  }
  scene.map.Apply(away);
  EXPECT_LT(Fuse(scene, world, kFirst, kSecond).size(), 5U);
}

// What one keyframe's landmarks were found to look like serves for the next that shows them, also
// where some were merged meanwhile.
TEST(FusionInto, FindsTheSameForAllThatShowALandmark) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene = TwoViews(world, true);
  const KeyFrameId third = AddKeyFrameTo(scene.map, PoseOnPath(3), scene.sensed[0]);
  MapEdit shown;
  for (const auto& [id, point] : scene.map.points()) {
    const auto seen = point.observations.find(kFirst);
    if (seen != point.observations.end()) {
      shown.push_back(edit::AddPointObservation{id, third, seen->second});
    }
  }
  scene.map.Apply(shown);
  Map at_once = scene.map, one_by_one = scene.map;
  FusionInto second(at_once, world.Imaging(), kSecond);
  for (const KeyFrameId from : {kFirst, third}) {
    at_once.Apply(second.Fuse(from));
    one_by_one.Apply(FusionInto(one_by_one, world.Imaging(), kSecond).Fuse(from));
  }
  ASSERT_LT(at_once.points().size(), scene.map.points().size());
  ASSERT_EQ(at_once.points().size(), one_by_one.points().size());
  for (const auto& [id, point] : at_once.points()) {
    ASSERT_NE(one_by_one.Find(id), nullptr);
    EXPECT_EQ(point.observations, one_by_one.Find(id)->observations);
  }
}

}  // namespace
}  // namespace plumbline
