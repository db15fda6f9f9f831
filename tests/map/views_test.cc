// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/map/appearance.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/map/snapshot.h"

#include "tests/map/map_fixture.h"
#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Chain of keyframes in which each pair (k, k + 1) shares `points` points and `lines` lines.
Map SharingChain(std::int64_t keyframes, int points, int lines) {
  Map map = ChainOfKeyFrames(keyframes);
  for (std::int64_t k = 0; k + 1 < keyframes; ++k) {
    const int base = k % 2 == 0 ? 0 : 20;  // one feature, one landmark
    for (int i = 0; i < points; ++i) {
      map.Apply({edit::AddPoint{PointSeenBy(map.NextPointId().value, SeenBy(k, k + 1, base + i))}});
    }
    for (int i = 0; i < lines; ++i) {
      map.Apply({edit::AddLine{LineSeenBy(map.NextLineId().value, SeenBy(k, k + 1, base + i))}});
    }
  }
  map.CheckInvariants();
  return map;
}

TEST(Covisible, CountsPointsAndLinesTogether) {
  const Map map = SharingChain(3, 4, 3);
  const auto of_first = Covisible(map, KeyFrameId{0}, 1);
  ASSERT_EQ(of_first.size(), 1U);
  EXPECT_EQ(of_first[0].id, KeyFrameId{1});
  EXPECT_EQ(of_first[0].shared, 7);
  EXPECT_TRUE(Covisible(map, KeyFrameId{0}, 8).empty());
  EXPECT_TRUE(Covisible(map, KeyFrameId{9}, 1).empty());
}

TEST(Covisible, OrdersByCountThenNewestFirst) {
  Map map = ChainOfKeyFrames(4);
  int feature = 0;
  std::int64_t id = 0;
  const auto share = [&](std::int64_t with, int count) {
    for (int i = 0; i < count; ++i, ++feature) {
      map.Apply({edit::AddPoint{
          PointSeenBy(id++, {{KeyFrameId{0}, feature}, {KeyFrameId{with}, feature}})}});
    }
  };
  share(1, 5);
  share(2, 8);
  share(3, 5);
  const auto neighbours = Covisible(map, KeyFrameId{0}, 5);
  ASSERT_EQ(neighbours.size(), 3U);
  EXPECT_EQ(neighbours[0].id, KeyFrameId{2});
  EXPECT_EQ(neighbours[1].id, KeyFrameId{3});
  EXPECT_EQ(neighbours[2].id, KeyFrameId{1});
}

TEST(Covisible, TheClosestAreItsFirst) {
  Map map = ChainOfKeyFrames(4);
  for (std::int64_t id = 0; id < 3 * kMinShared; ++id) {
    const int feature = static_cast<int>(id);
    map.Apply({edit::AddPoint{
        PointSeenBy(id, {{KeyFrameId{0}, feature}, {KeyFrameId{1 + id % 3}, feature}})}});
  }
  const auto closest = ClosestCovisible(map, KeyFrameId{0}, 2);
  ASSERT_EQ(closest.size(), 2U);
  EXPECT_EQ(closest[0].id, KeyFrameId{3});
  EXPECT_EQ(closest[1].id, KeyFrameId{2});
  EXPECT_EQ(ClosestCovisible(map, KeyFrameId{0}, 5).size(), 3U);
  EXPECT_TRUE(ClosestCovisible(map, KeyFrameId{0}, 0).empty());
}

TEST(Snapshot, HoldsAllLandmarksOfItsKeyFramesSortedById) {
  const Map map = SharingChain(6, 8, 4);
  const auto snapshot = TakeSnapshot(map, KeyFrameId{5}, 40);
  EXPECT_EQ(snapshot->centre, KeyFrameId{5});
  EXPECT_EQ(snapshot->reference->id, KeyFrameId{5});
  // 5 sees 4, and 4 sees 3: neighbours and theirs.
  ASSERT_EQ(snapshot->cam_from_world.size(), 3U);
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  EXPECT_TRUE(std::is_sorted(snapshot->points.begin(), snapshot->points.end(), by_id));
  EXPECT_TRUE(std::is_sorted(snapshot->lines.begin(), snapshot->lines.end(), by_id));
  std::size_t points = 0;
  std::size_t lines = 0;
  for (const auto& [id, point] : map.points()) {
    const bool inside = point.observations.newest().first >= KeyFrameId{3};
    EXPECT_EQ(snapshot->Find(id) != nullptr, inside) << id.value;
    points += inside;
  }
  for (const auto& [id, line] : map.lines()) {
    const bool inside = line.observations.newest().first >= KeyFrameId{3};
    EXPECT_EQ(snapshot->Find(id) != nullptr, inside) << id.value;
    lines += inside;
  }
  EXPECT_EQ(snapshot->points.size(), points);
  EXPECT_EQ(snapshot->lines.size(), lines);
  EXPECT_EQ(snapshot->points.front().observation_count, 2);
  for (const auto& [id, pose] : snapshot->cam_from_world) {
    EXPECT_EQ(pose.translation, map.Find(id)->frame.cam_from_world.translation);
  }
}

TEST(Snapshot, TakesNoMoreKeyFramesThanAsked) {
  const Map map = SharingChain(6, 8, 4);
  EXPECT_EQ(TakeSnapshot(map, KeyFrameId{3}, 1)->cam_from_world.size(), 1U);
  EXPECT_EQ(TakeSnapshot(map, KeyFrameId{3}, 2)->cam_from_world.size(), 2U);
  EXPECT_EQ(TakeSnapshot(map, KeyFrameId{3}, 3)->cam_from_world.size(), 3U);
  EXPECT_THROW(TakeSnapshot(map, KeyFrameId{8}, 3), BugError);
}

TEST(Snapshot, StaysAsItWas) {
  Map map = SharingChain(2, 12, 0);
  const auto snapshot = TakeSnapshot(map, KeyFrameId{1}, 40);
  map.Apply({edit::MovePoint{PointId{0}, {9, 9, 9}},
             edit::RemovePoint{PointId{1}},
             edit::SetPose{KeyFrameId{1}, {}}});
  EXPECT_EQ(snapshot->Find(PointId{0})->position, Eigen::Vector3d(0, 0, 5));
  EXPECT_NE(snapshot->Find(PointId{1}), nullptr);
  EXPECT_EQ(snapshot->cam_from_world.at(KeyFrameId{1}).translation.x(), 1);
  EXPECT_EQ(snapshot->reference->frame.points[1], PointId{1});
}

// Keyframe whose point and line feature 0 have a descriptor with so many bits set.
KeyFrame Looking(std::int64_t id, int bits, int octave) {
  KeyFrame keyframe = BlankKeyFrame(id, id - 1);
  FrameFeatures indexed = *keyframe.frame.indexed;
  Descriptor descriptor{};
  for (int b = 0; b < bits; ++b) {
    descriptor[static_cast<std::size_t>(b / 64)] |= std::uint64_t{1} << (b % 64);
  }
  indexed.features.points[0].descriptor = descriptor;
  indexed.features.points[0].octave = static_cast<std::int16_t>(octave);
  indexed.features.lines[0].descriptor = descriptor;
  keyframe.frame.indexed = std::make_shared<const FrameFeatures>(std::move(indexed));
  return keyframe;
}

int BitCount(const Descriptor& descriptor) { return HammingDistance(descriptor, Descriptor{}); }

TEST(Appearance, TakesTheMostTypicalDescriptor) {
  Map map;
  // Distances to the others: 100 -> {50, 60, 98, 99}; 50 -> {10, 48, 49, 50}; 2 -> {1, 38, 48, 98}.
  const int bits[] = {100, 50, 2, 40, 1};
  for (std::int64_t k = 0; k < 5; ++k) {
    map.Apply({edit::AddKeyFrame{Looking(k, bits[k], static_cast<int>(k))}});
  }
  map.Apply({edit::AddPoint{PointSeenBy(0, SeenBy(0, 4, 0))},
             edit::AddLine{LineSeenBy(0, SeenBy(0, 4, 0))}});
  map.Apply({edit::RefreshPoint{PointId{0}}, edit::RefreshLine{LineId{0}}});
  EXPECT_EQ(BitCount(map.Find(PointId{0})->descriptor), 2);
  EXPECT_EQ(BitCount(map.Find(LineId{0})->descriptor), 2);
}

TEST(Appearance, EqualDescriptorsGoToTheOldest) {
  Map map;
  map.Apply({edit::AddKeyFrame{Looking(0, 30, 0)}, edit::AddKeyFrame{Looking(1, 90, 0)}});
  map.Apply({edit::AddPoint{PointSeenBy(0, SeenBy(0, 1, 0))}, edit::RefreshPoint{PointId{0}}});
  EXPECT_EQ(BitCount(map.Find(PointId{0})->descriptor), 30);
}

TEST(Appearance, ScaleIsThatOfTheNewestView) {
  Map map;
  for (std::int64_t k = 0; k < 3; ++k) {
    map.Apply({edit::AddKeyFrame{Looking(k, 5, static_cast<int>(k))}});
  }
  map.Apply({edit::AddPoint{PointSeenBy(0, SeenBy(0, 2, 0))}, edit::RefreshPoint{PointId{0}}});
  const MapPoint& point = *map.Find(PointId{0});
  // Keyframe k stands at x = -k, the point at (0, 0, 5).
  EXPECT_NEAR(point.reference_distance, std::sqrt(4 + 25.0), 1e-12);
  EXPECT_EQ(point.reference_octave, 2);
  const Eigen::Vector3d sum = Eigen::Vector3d(0, 0, 5).normalized() +
                              Eigen::Vector3d(1, 0, 5).normalized() +
                              Eigen::Vector3d(2, 0, 5).normalized();
  EXPECT_LT((point.view_direction - sum.normalized()).norm(), 1e-12);
}

TEST(Appearance, OldViewsOfAnOftenSeenLandmarkDoNotCount) {
  Map map;
  for (std::int64_t k = 0; k < 22; ++k) {
    map.Apply({edit::AddKeyFrame{Looking(k, k < 10 ? 10 : 200, 0)}});
  }
  map.Apply({edit::AddPoint{PointSeenBy(0, SeenBy(0, 21, 0))}, edit::RefreshPoint{PointId{0}}});
  EXPECT_EQ(BitCount(map.Find(PointId{0})->descriptor), 200);
}

}  // namespace
}  // namespace plumbline
