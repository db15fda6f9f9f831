// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_map.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace line_map_test {

const SensorModel kNoisy{.points = false, .noise = 0.5};

TrueMap Scene(const SyntheticWorld& world, int keyframes = 8) {
  std::vector<Rigid3> poses;
  for (int k = 0; k < keyframes; ++k) poses.push_back(PoseOnPath(8 * k));
  return MakeTrueMap(world, poses, kNoisy);
}

// Of the two ends from the nearest true line, metres; ends may lie 10 cm beyond the true ones.
double DistanceFromTruth(const MappedLine& line, const SyntheticWorld& world) {
  double nearest = 1e9;
  for (const SyntheticWorld::Line& truth : world.lines) {
    const Eigen::Vector3d d = truth.segment.Direction();
    const Segment3 longer{truth.segment.start - 0.1 * d, truth.segment.end + 0.1 * d};
    nearest = std::min(
        nearest,
        std::max(Distance(longer, line.segment.start), Distance(longer, line.segment.end)));
  }
  return nearest;
}

double Length(const std::vector<MappedLine>& lines) {
  double sum = 0;
  for (const MappedLine& line : lines) sum += line.segment.Length();
  return sum;
}

TEST(LineMap, HasTheLinesOfTheWorld) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  const LineMapOptions options;
  const auto lines = MakeLineMap(scene.map, world.Imaging(), options);
  EXPECT_GT(lines.size(), 15U);
  std::size_t good = 0;
  for (const MappedLine& line : lines) {
    good += DistanceFromTruth(line, world) < std::max(0.1, 3 * line.sigma);
    EXPECT_GE(line.keyframes, options.min_keyframes);
    EXPECT_GT(line.sigma, 0);
    EXPECT_LT(line.sigma, 0.3);
    EXPECT_GT(line.segment.Length(), 0);
  }
  EXPECT_GE(static_cast<double>(good), 0.95 * static_cast<double>(lines.size()));
}

TEST(LineMap, HasTheFirstLinesWhenItIsStopped) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  const auto all = MakeLineMap(scene.map, world.Imaging(), {});
  EXPECT_TRUE(MakeLineMap(scene.map, world.Imaging(), {}, [] { return true; }).empty());
  int asked = 0;
  const auto some = MakeLineMap(scene.map, world.Imaging(), {}, [&] { return asked++ >= 10; });
  EXPECT_LT(some.size(), all.size());
  ASSERT_FALSE(some.empty());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].segment.start, all[i].segment.start);
  }
}

TEST(LineMap, SegmentsOfLinesAreInTheirOrder) {
  const MappedLine first{{{0, 0, 1}, {1, 0, 1}}}, second{{{0, 1, 1}, {0, 2, 1}}};
  const std::vector<Segment3> segments = SegmentsOf({first, second});
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].end, first.segment.end);
  EXPECT_EQ(segments[1].end, second.segment.end);
}

TEST(LineMap, HasALineOnceHoweverOftenItIsInTheMap) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  TrueMap scene = Scene(world);
  const auto once = MakeLineMap(scene.map, world.Imaging(), {});
  MapEdit edit;
  LineId next = scene.map.NextLineId();
  for (const auto& [id, line] : scene.map.lines()) {
    // Takes over half of the observations, at the other half of the line.
    MapLine twin = line;
    twin.id = next;
    ++next.value;
    twin.start = 0.5 * (line.start + line.end);
    twin.observations = {};
    for (const auto& [keyframe, feature] : line.observations) {
      if (keyframe.value % 2 == 0) continue;
      edit.push_back(edit::RemoveLineObservation{id, keyframe});
      twin.observations.emplace(keyframe, feature);
    }
    if (!twin.observations.empty()) edit.push_back(edit::AddLine{twin});
  }
  scene.map.Apply(edit);
  ASSERT_GT(2 * scene.map.lines().size(), 3 * scene.line_of.size());
  const auto twice = MakeLineMap(scene.map, world.Imaging(), {});
  EXPECT_NEAR(static_cast<double>(twice.size()), static_cast<double>(once.size()), 2);
  EXPECT_NEAR(Length(twice), Length(once), 0.05 * Length(once));
}

// How far the keyframes from one id up to another are from a line that they show.
std::vector<double> DistancesOf(const WellSeenLine& line, KeyFrameId from, KeyFrameId to) {
  std::vector<double> distances;
  const Eigen::Vector3d middle = line.pieces.front().segment.Midpoint();
  for (const LineSupport& support : line.supports) {
    const KeyFrame& keyframe = *support.keyframe;
    if (keyframe.id < from || !(keyframe.id < to)) continue;
    distances.push_back((keyframe.frame.cam_from_world * middle).norm());
  }
  return distances;
}

TEST(LineMap, SearchesThreeTimesAsFarAsALineIsKnownToBeSeen) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 200);
  constexpr int kNear = 8, kFar = 4;
  std::vector<Rigid3> poses;
  for (int k = 0; k < kNear + kFar; ++k) {
    poses.push_back(PoseOnPath(8 * (k % kNear)));
    if (k >= kNear) poses.back().translation.z() += 20;
  }
  TrueMap scene = MakeTrueMap(world, poses, kNoisy);
  // Lines that are shown from more than three times as far as by any of the near keyframes.
  const auto shown_from_afar = [&](const Map& map) {
    int count = 0;
    for (const WellSeenLine& line : FindWellSeenLines(map, world.Imaging(), {})) {
      const auto near = DistancesOf(line, KeyFrameId{0}, KeyFrameId{kNear});
      const auto far = DistancesOf(line, KeyFrameId{kNear}, KeyFrameId{kNear + kFar});
      if (near.empty() || far.empty()) continue;
      count += *std::min_element(far.begin(), far.end()) >
               3.2 * *std::max_element(near.begin(), near.end());
    }
    return count;
  };
  EXPECT_GT(shown_from_afar(scene.map), 3);
  MapEdit forget;
  for (const auto& [id, line] : scene.map.lines()) {
    for (const auto& [keyframe, feature] : line.observations) {
      if (!(keyframe < KeyFrameId{kNear})) {
        forget.push_back(edit::RemoveLineObservation{id, keyframe});
      }
    }
  }
  scene.map.Apply(forget);
  EXPECT_EQ(shown_from_afar(scene.map), 0);
}

TEST(LineMap, LeavesOutLandmarksThatAreInTheWrongPlace) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  TrueMap scene = Scene(world);
  const auto before = MakeLineMap(scene.map, world.Imaging(), {});
  MapEdit edit;
  LineId next = scene.map.NextLineId();
  const IdTable<LineId, MapLine> landmarks = scene.map.lines();
  for (const auto& [id, line] : landmarks) {
    MapLine ghost = line;
    const Eigen::Vector3d shift(0.3, -0.4, 1);
    ghost.id = next;
    ++next.value;
    ghost.line = LineThroughPoints(line.line.PointAt(line.start) + shift,
                                   line.line.PointAt(line.end) + shift);
    ghost.start = ghost.line.ParameterOf(line.line.PointAt(line.start) + shift);
    ghost.end = ghost.line.ParameterOf(line.line.PointAt(line.end) + shift);
    edit.push_back(edit::RemoveLine{id});
    edit.push_back(edit::AddLine{ghost});
  }
  scene.map.Apply(edit);
  EXPECT_LT(Length(MakeLineMap(scene.map, world.Imaging(), {})), 0.1 * Length(before));
}

TEST(LineMap, NeedsEnoughKeyFrames) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world, 3);
  EXPECT_TRUE(MakeLineMap(scene.map, world.Imaging(), {}).empty());
  LineMapOptions options;
  options.min_keyframes = 2;
  EXPECT_FALSE(MakeLineMap(scene.map, world.Imaging(), options).empty());
  EXPECT_TRUE(MakeLineMap(Map(), world.Imaging(), options).empty());
}

TEST(LineMap, NeedsWellKnownLines) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  LineMapOptions strict, lax;
  strict.max_relative_sigma = 0.004;
  lax.max_relative_sigma = 0.5;
  const double length = Length(MakeLineMap(scene.map, world.Imaging(), {}));
  EXPECT_LT(Length(MakeLineMap(scene.map, world.Imaging(), strict)), 0.9 * length);
  EXPECT_GT(Length(MakeLineMap(scene.map, world.Imaging(), lax)), 1.05 * length);
}

TEST(LineMap, NeedsLinesThatAreFoundOftenEnough) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  LineMapOptions never;
  never.min_found_ratio = 1;
  EXPECT_LT(Length(MakeLineMap(scene.map, world.Imaging(), never)),
            Length(MakeLineMap(scene.map, world.Imaging(), {})));
}

TEST(LineMap, NeedsLinesThatPassThroughTheirSegments) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  LineMapOptions strict, lax;
  strict.max_mean_chi2 = 0.1;
  lax.max_mean_chi2 = 1000;
  const double length = Length(MakeLineMap(scene.map, world.Imaging(), {}));
  EXPECT_LT(Length(MakeLineMap(scene.map, world.Imaging(), strict)), 0.5 * length);
  EXPECT_NEAR(Length(MakeLineMap(scene.map, world.Imaging(), lax)), length, 0.05 * length);
}

TEST(LineMap, NeedsLinesThatAreLongInTheImages) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const TrueMap scene = Scene(world);
  LineMapOptions strict, none;
  strict.min_mean_length_px = 120;
  none.min_mean_length_px = 1000;
  const double length = Length(MakeLineMap(scene.map, world.Imaging(), {}));
  EXPECT_LT(Length(MakeLineMap(scene.map, world.Imaging(), strict)), 0.9 * length);
  EXPECT_GT(Length(MakeLineMap(scene.map, world.Imaging(), strict)), 0);
  EXPECT_EQ(Length(MakeLineMap(scene.map, world.Imaging(), none)), 0);
}

// At any scale: a map of one camera has its own unit.
TEST(LineMap, DoesNotDependOnTheUnit) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  const SensorModel mono{.points = false, .depth = false, .noise = 0.5};
  std::vector<Rigid3> poses;
  for (int k = 0; k < 8; ++k) poses.push_back(PoseOnPath(8 * k));
  TrueMap scene = MakeTrueMap(world, poses, mono);
  const auto lines = MakeLineMap(scene.map, world.Imaging(), {});
  constexpr double kScale = 0.1;
  MapEdit edit;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    Rigid3 pose = keyframe.frame.cam_from_world;
    pose.translation *= kScale;
    edit.push_back(edit::SetPose{id, pose});
  }
  scene.map.Apply(edit);
  edit.clear();
  for (const auto& [id, line] : scene.map.lines()) {
    edit::MoveLine move{id, line.line, kScale * line.start, kScale * line.end, {}};
    move.line.moment *= kScale;
    move.information = Eigen::Matrix4d::Zero();
    for (const auto& [keyframe, feature] : line.observations) {
      move.information += LineInformation(world.camera,
                                          scene.map.Find(keyframe)->frame,
                                          static_cast<std::size_t>(feature),
                                          move.line);
    }
    edit.push_back(move);
  }
  scene.map.Apply(edit);
  const auto small = MakeLineMap(scene.map, world.Imaging(), {});
  ASSERT_GT(lines.size(), 5U);
  EXPECT_NEAR(static_cast<double>(small.size()), static_cast<double>(lines.size()), 2);
  EXPECT_NEAR(Length(small), kScale * Length(lines), 0.1 * kScale * Length(lines));
}

}  // namespace line_map_test
}  // namespace plumbline
