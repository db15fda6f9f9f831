// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/map.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include "tests/map/map_fixture.h"
#include "tests/support/random_geometry.h"
#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr KeyFrameId kF0{0}, kF1{1}, kF2{2}, kF3{3};
constexpr PointId kP0{0}, kP1{1}, kP2{2};
constexpr LineId kL0{0}, kL1{1};

TEST(Map, StartsEmpty) {
  const Map map(MapId{3});
  EXPECT_EQ(map.id(), MapId{3});
  EXPECT_TRUE(map.keyframes().empty());
  EXPECT_EQ(map.Find(kF0), nullptr);
  EXPECT_EQ(map.Find(kP0), nullptr);
  EXPECT_EQ(map.Find(kL0), nullptr);
  EXPECT_FALSE(map.Current(kP0).valid());
  EXPECT_NO_THROW(map.CheckInvariants());
}

TEST(Map, IsTheOnlyOneOfItsToken) {
  Map map = ChainOfKeyFrames(2);
  const auto token = map.token();
  ASSERT_TRUE(token);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 4}})}});
  EXPECT_EQ(map.token(), token);
  Map copy = map;
  EXPECT_TRUE(copy.token());
  EXPECT_NE(copy.token(), token);
  Map moved = std::move(map);
  EXPECT_EQ(moved.token(), token);
  EXPECT_EQ(moved.keyframes().size(), 2U);
  moved = copy;
  EXPECT_TRUE(moved.token());
  EXPECT_NE(moved.token(), token);
  EXPECT_NE(moved.token(), copy.token());
  const auto of_copy = copy.token();
  moved = std::move(copy);
  EXPECT_EQ(moved.token(), of_copy);
}

TEST(Map, LandmarksAndKeyFramesKnowOfEachOther) {
  Map map = ChainOfKeyFrames(3);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 4}, {kF2, 5}})},
             edit::AddLine{LineSeenBy(0, {{kF1, 6}})}});
  map.CheckInvariants();
  EXPECT_EQ(map.Find(kF0)->frame.points[4], kP0);
  EXPECT_EQ(map.Find(kF2)->frame.points[5], kP0);
  EXPECT_EQ(map.Find(kF1)->frame.lines[6], kL0);
  EXPECT_EQ(map.NextPointId(), kP1);
  EXPECT_EQ(map.NextLineId(), kL1);
  EXPECT_EQ(map.NextKeyFrameId(), kF3);
}

TEST(Map, PointPositionsAreInTheOrderOfIds) {
  Map map = ChainOfKeyFrames(2);
  EXPECT_TRUE(PointPositions(map).empty());
  MapPoint first = PointSeenBy(0, {{kF0, 4}}), second = PointSeenBy(1, {{kF1, 5}});
  first.position = {1, 2, 3};
  second.position = {4, 5, 6};
  map.Apply({edit::AddPoint{first}, edit::AddPoint{second}});
  EXPECT_EQ(PointPositions(map), (std::vector<Eigen::Vector3d>{first.position, second.position}));
}

TEST(Map, IdsAreNeverUsedTwice) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 4}})}, edit::RemovePoint{kP0}});
  EXPECT_EQ(map.NextPointId(), kP1);
  EXPECT_THROW(map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 4}})}}), BugError);
  map.Apply({edit::RemoveKeyFrame{kF1}});
  EXPECT_EQ(map.NextKeyFrameId(), kF2);
  EXPECT_THROW(map.Apply({edit::AddKeyFrame{BlankKeyFrame(1, 0)}}), BugError);
}

TEST(Map, ALandmarkThatNobodySeesIsNotAdded) {
  Map map = ChainOfKeyFrames(1);
  map.Apply({edit::AddPoint{PointSeenBy(0, {})}, edit::AddLine{LineSeenBy(0, {{kF3, 0}})}});
  EXPECT_EQ(map.Find(kP0), nullptr);
  EXPECT_EQ(map.Find(kL0), nullptr);
  EXPECT_EQ(map.NextPointId(), kP1);
  map.CheckInvariants();
}

TEST(Map, AFeatureShowsTheNewestLandmarkGivenToIt) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 4}, {kF1, 4}})},
             edit::AddPoint{PointSeenBy(1, {{kF1, 4}})}});
  EXPECT_EQ(map.Find(kF1)->frame.points[4], kP1);
  EXPECT_EQ(map.Find(kP0)->observations, (Observations{{kF0, 4}}));
  map.Apply({edit::AddPointObservation{kP1, kF0, 4}});  // takes the last one away
  EXPECT_EQ(map.Find(kP0), nullptr);
  map.CheckInvariants();
}

TEST(Map, AKeyFrameShowsALandmarkOnce) {
  Map map = ChainOfKeyFrames(1);
  map.Apply({edit::AddLine{LineSeenBy(0, {{kF0, 4}})}, edit::AddLineObservation{kL0, kF0, 5}});
  EXPECT_EQ(map.Find(kL0)->observations, (Observations{{kF0, 4}}));
  EXPECT_FALSE(map.Find(kF0)->frame.lines[5].valid());
  map.CheckInvariants();
}

TEST(Map, LosingTheLastObservationRemovesTheLandmark) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddLine{LineSeenBy(0, {{kF0, 4}, {kF1, 7}})},
             edit::AddPoint{PointSeenBy(0, {{kF0, 1}, {kF1, 2}})}});
  map.Apply({edit::RemoveLineObservation{kL0, kF0}, edit::RemovePointObservation{kP0, kF1}});
  EXPECT_EQ(map.Find(kL0)->observations, (Observations{{kF1, 7}}));
  EXPECT_EQ(map.Find(kP0)->observations, (Observations{{kF0, 1}}));
  map.CheckInvariants();
  map.Apply({edit::RemoveLineObservation{kL0, kF1}, edit::RemovePointObservation{kP0, kF0}});
  EXPECT_EQ(map.Find(kL0), nullptr);
  EXPECT_EQ(map.Find(kP0), nullptr);
  EXPECT_FALSE(map.Find(kF1)->frame.lines[7].valid());
  map.CheckInvariants();
}

TEST(Map, ChangesOfWhatIsGoneAreSkipped) {
  Map map = ChainOfKeyFrames(1);
  const PointId none{77};
  const LineId no_line{77};
  map.Apply({edit::RemovePoint{none},
             edit::RemoveLine{no_line},
             edit::MovePoint{none, Eigen::Vector3d::Ones()},
             edit::MoveLine{no_line, {}, 0, 1, Eigen::Matrix4d::Identity()},
             edit::AddPointObservation{none, kF0, 0},
             edit::AddLineObservation{no_line, kF0, 0},
             edit::RemovePointObservation{none, kF0},
             edit::RemoveLineObservation{no_line, kF0},
             edit::MergePoints{none, kP0},
             edit::MergeLines{no_line, kL0},
             edit::RefreshPoint{none},
             edit::RefreshLine{no_line},
             edit::ScorePoint{none, 1, 1},
             edit::ScoreLine{no_line, 1, 1},
             edit::SetPose{kF3, {}},
             edit::RemoveKeyFrame{kF3}});
  EXPECT_EQ(map.keyframes().size(), 1U);
  EXPECT_TRUE(map.points().empty());
  EXPECT_TRUE(map.lines().empty());
  map.CheckInvariants();
}

TEST(Map, CorrectsTheDisparitiesOfAllKeyFramesOnceForAll) {
  Map map = ChainOfKeyFrames(1);
  KeyFrame keyframe = BlankKeyFrame(1, 0);
  auto features = std::make_shared<FrameFeatures>(*keyframe.frame.indexed);
  features->features.point_disparity.Set(0, Disparity{10, 1});
  keyframe.frame.indexed = features;
  const RectifiedCamera camera{400, 400, 320, 240, 0.1, 640, 480};
  const auto disparity = [&](std::int64_t id) {
    return map.Find(KeyFrameId{id})->frame.features().point_disparity[0]->px;
  };
  map.Apply({edit::AddKeyFrame{keyframe}});
  map.Apply({edit::CorrectFeatures{{{camera, 0.5 * Vector6d::Unit(0)}}}});
  EXPECT_DOUBLE_EQ(disparity(1), 9.5);
  keyframe.id = KeyFrameId{2};
  map.Apply({edit::AddKeyFrame{keyframe}});
  EXPECT_DOUBLE_EQ(disparity(2), 9.5);
  map.Apply({edit::CorrectFeatures{{{camera, 0.2 * Vector6d::Unit(0)}}}});
  EXPECT_DOUBLE_EQ(disparity(1), 9.8);
  EXPECT_DOUBLE_EQ(disparity(2), 9.8);
  EXPECT_DOUBLE_EQ(features->features.point_disparity[0]->px, 10);
}

TEST(Map, FeaturesAreMovedWithinAKeyFrame) {
  Map map = ChainOfKeyFrames(2);
  const auto before = map.Find(kF1)->frame.indexed;
  Features moved = before->features;
  moved.points[3].px += Eigen::Vector2d(0.5, -0.25);
  const auto indexed = IndexFeatures(TestCamera(), moved);
  map.Apply({edit::MoveFeatures{kF1, indexed}, edit::MoveFeatures{kF3, indexed}});
  map.CheckInvariants();
  EXPECT_EQ(map.Find(kF1)->frame.features().points[3].px, moved.points[3].px);
  EXPECT_EQ(map.Find(kF0)->frame.features().points[3].px, before->features.points[3].px);
}

TEST(Map, MovesAndScoresAreTakenOver) {
  Map map = ChainOfKeyFrames(1);
  const PluckerLine moved = LineThroughPoints({0, 1, 5}, {1, 1, 5});
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 0}})}, edit::AddLine{LineSeenBy(0, {{kF0, 0}})}});
  map.Apply({edit::MovePoint{kP0, {1, 2, 3}},
             edit::MoveLine{kL0, moved, -1, 2, 3 * Eigen::Matrix4d::Identity()},
             edit::ScorePoint{kP0, 9, 4},
             edit::ScoreLine{kL0, 3, 1},
             edit::SetPose{kF0, {Eigen::Quaterniond::Identity(), {7, 8, 9}}}});
  EXPECT_EQ(map.Find(kP0)->position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(map.Find(kP0)->score.Ratio(), 0.5);  // 1 + 4 of 1 + 9
  EXPECT_EQ(map.Find(kL0)->score.Ratio(), 0.5);
  EXPECT_EQ(map.Find(kL0)->line.moment, moved.moment);
  EXPECT_EQ(map.Find(kL0)->start, -1);
  EXPECT_EQ(map.Find(kL0)->end, 2);
  EXPECT_EQ(map.Find(kL0)->information(2, 2), 3);
  EXPECT_EQ(map.Find(kF0)->frame.cam_from_world.translation, Eigen::Vector3d(7, 8, 9));
}

TEST(Map, MergingMovesObservationsAndScores) {
  Map map = ChainOfKeyFrames(3);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 1}, {kF1, 1}})},
             edit::AddPoint{PointSeenBy(1, {{kF1, 2}, {kF2, 2}})},
             edit::ScorePoint{kP1, 4, 2}});
  map.Apply({edit::MergePoints{kP0, kP1}});
  EXPECT_EQ(map.Find(kP1), nullptr);
  EXPECT_EQ(map.Find(kP0)->observations, (Observations{{kF0, 1}, {kF1, 1}, {kF2, 2}}));
  EXPECT_FALSE(map.Find(kF1)->frame.points[2].valid());
  EXPECT_EQ(map.Find(kP0)->score.visible, 6);
  EXPECT_EQ(map.Find(kP0)->score.found, 4);
  map.CheckInvariants();
}

TEST(Map, CurrentFollowsChainsOfMerges) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 0}})},
             edit::AddPoint{PointSeenBy(1, {{kF0, 1}})},
             edit::AddPoint{PointSeenBy(2, {{kF0, 2}})},
             edit::AddLine{LineSeenBy(0, {{kF0, 0}})},
             edit::AddLine{LineSeenBy(1, {{kF0, 1}})}});
  map.Apply({edit::MergePoints{kP1, kP0}, edit::MergePoints{kP2, kP1}, edit::MergeLines{kL1, kL0}});
  EXPECT_EQ(map.Current(kP0), kP2);
  EXPECT_EQ(map.Current(kP1), kP2);
  EXPECT_EQ(map.Current(kP2), kP2);
  EXPECT_EQ(map.Current(kL0), kL1);
  map.Apply({edit::MergePoints{kP2, kP2}});  // with itself: nothing
  EXPECT_NE(map.Find(kP2), nullptr);
  map.Apply({edit::RemovePoint{kP2}});
  EXPECT_FALSE(map.Current(kP0).valid());
}

TEST(Map, ANewKeyFrameShowsLandmarksAsTheyStandToday) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 0}})},
             edit::AddPoint{PointSeenBy(1, {{kF0, 1}})},
             edit::AddPoint{PointSeenBy(2, {{kF0, 2}})},
             edit::MergePoints{kP1, kP0},
             edit::RemovePoint{kP2}});
  KeyFrame keyframe = BlankKeyFrame(2, 1);
  keyframe.frame.points[10] = kP0;  // merged into 1
  keyframe.frame.points[11] = kP2;  // gone
  keyframe.frame.points[12] = kP1;  // the same point a second time
  map.Apply({edit::AddKeyFrame{keyframe}});
  EXPECT_EQ(map.Find(kF2)->frame.points[10], kP1);
  EXPECT_FALSE(map.Find(kF2)->frame.points[11].valid());
  EXPECT_FALSE(map.Find(kF2)->frame.points[12].valid());
  EXPECT_EQ(map.Find(kP1)->observations.at(kF2), 10);
  map.CheckInvariants();
}

TEST(Map, RemovingAKeyFrameRemovesWhatOnlyItShows) {
  Map map = ChainOfKeyFrames(3);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF1, 0}})},
             edit::AddPoint{PointSeenBy(1, {{kF1, 1}, {kF2, 1}})},
             edit::AddLine{LineSeenBy(0, {{kF1, 0}})}});
  map.Apply({edit::RemoveKeyFrame{kF1}});
  EXPECT_EQ(map.Find(kF1), nullptr);
  EXPECT_EQ(map.Find(kP0), nullptr);
  EXPECT_EQ(map.Find(kL0), nullptr);
  EXPECT_EQ(map.Find(kP1)->observations, (Observations{{kF2, 1}}));
  map.CheckInvariants();
}

TEST(Map, TheFirstKeyFrameStays) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::RemoveKeyFrame{kF0}});
  EXPECT_NE(map.Find(kF0), nullptr);
}

TEST(Map, RemovedKeyFramesMoveWithTheirAncestors) {
  Rng rng(4);
  Map map = ChainOfKeyFrames(4);
  std::vector<Rigid3> before;
  for (std::int64_t k = 0; k < 4; ++k) {
    before.push_back(RandomRigid(rng));
    map.Apply({edit::SetPose{KeyFrameId{k}, before.back()}});
  }
  map.Apply({edit::RemoveKeyFrame{kF2}});
  map.Apply({edit::RemoveKeyFrame{kF1}});  // the parent of one removed before
  const auto expect_pose = [&](KeyFrameId id, const Rigid3& expected) {
    EXPECT_LT(LogSe3(map.PoseOf(id) * Inverse(expected)).norm(), 1e-9) << id.value;
  };
  for (std::int64_t k = 0; k < 4; ++k) {
    expect_pose(KeyFrameId{k}, before[static_cast<std::size_t>(k)]);
  }
  const Rigid3 moved = RandomRigid(rng);
  map.Apply({edit::SetPose{kF0, moved}});
  expect_pose(kF1, before[1] * Inverse(before[0]) * moved);
  expect_pose(kF2, before[2] * Inverse(before[0]) * moved);
  expect_pose(kF3, before[3]);
  EXPECT_THROW(map.PoseOf(KeyFrameId{9}), BugError);
  // Removed with an ancestor that is removed already.
  map.Apply({edit::RemoveKeyFrame{kF3}});
  expect_pose(kF3, before[3]);
}

TEST(Map, NoChainsOfRemovedKeyFramesGrow) {
  Rng rng(8);
  Map map = ChainOfKeyFrames(60);
  std::vector<Rigid3> before;
  for (std::int64_t k = 0; k < 60; ++k) {
    before.push_back(RandomRigid(rng));
    map.Apply({edit::SetPose{KeyFrameId{k}, before.back()}});
  }
  std::vector<std::int64_t> gone;
  for (std::int64_t k = 1; k < 60; ++k) gone.push_back(k);
  for (std::size_t i = gone.size(); i > 1; --i) std::swap(gone[i - 1], gone[rng.Index(i)]);
  for (const std::int64_t k : gone) {
    map.Apply({edit::RemoveKeyFrame{KeyFrameId{k}}});
    for (const auto& [id, removed] : map.Record().removed_keyframes) {
      ASSERT_NE(map.Find(removed.parent), nullptr);
    }
  }
  for (std::int64_t k = 0; k < 60; ++k) {
    const Rigid3& expected = before[static_cast<std::size_t>(k)];
    EXPECT_LT(LogSe3(map.PoseOf(KeyFrameId{k}) * Inverse(expected)).norm(), 1e-9) << k;
  }
}

TEST(Map, RemembersTheLastMergesOnly) {
  Map map = ChainOfKeyFrames(2);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{kF0, 0}})}});
  const auto count = static_cast<std::int64_t>(Map::kMostMerges) + 100;
  for (std::int64_t i = 1; i <= count; ++i) {
    map.Apply({edit::AddPoint{PointSeenBy(i, {{kF1, 1}})},
               edit::MergePoints{PointId{0}, PointId{i}},
               edit::RemovePointObservation{PointId{0}, kF1}});
  }
  EXPECT_EQ(map.Record().merged_points.size(), Map::kMostMerges);
  EXPECT_EQ(map.Current(PointId{count}), PointId{0});
  EXPECT_EQ(map.Current(PointId{1}), PointId{});
  map.CheckInvariants();
}

// One random change, mostly of things that exist.
MapChange RandomChange(const Map& map, Rng& rng) {
  const auto upto = [&](std::int64_t next) {
    return static_cast<std::int64_t>(rng.Index(static_cast<std::size_t>(next) + 1));
  };
  const PointId p{upto(map.NextPointId().value)}, q{upto(map.NextPointId().value)};
  const LineId l{upto(map.NextLineId().value)}, m{upto(map.NextLineId().value)};
  const KeyFrameId k{upto(map.NextKeyFrameId().value)};
  const int feature = static_cast<int>(rng.Index(kFeatures));
  Observations seen{{k, feature}};
  const KeyFrameId other{upto(map.NextKeyFrameId().value)};
  seen.emplace(other, static_cast<int>(rng.Index(kFeatures)));
  KeyFrame keyframe = BlankKeyFrame(map.NextKeyFrameId().value, map.NextKeyFrameId().value - 1);
  for (std::size_t i = 0; i < kFeatures; i += 2) {
    keyframe.frame.points[i] = PointId{upto(map.NextPointId().value)};
    keyframe.frame.lines[i] = LineId{upto(map.NextLineId().value)};
  }
  switch (rng.Index(18)) {
    case 0:
      return edit::AddKeyFrame{keyframe};
    case 1:
      return edit::RemoveKeyFrame{k};
    case 2:
      return edit::RemovePoint{p};
    case 3:
      return edit::RemoveLine{l};
    case 4:
      return edit::AddPointObservation{p, k, feature};
    case 5:
      return edit::AddLineObservation{l, k, feature};
    case 6:
      return edit::RemovePointObservation{p, k};
    case 7:
      return edit::RemoveLineObservation{l, k};
    case 8:
      return edit::MergePoints{p, q};
    case 9:
      return edit::MergeLines{l, m};
    case 10:
      return edit::RefreshPoint{p};
    case 11:
      return edit::RefreshLine{l};
    case 12:
    case 13:
    case 14:
      return edit::AddLine{LineSeenBy(map.NextLineId().value, seen)};
    default:
      return edit::AddPoint{PointSeenBy(map.NextPointId().value, seen)};
  }
}

TEST(Map, InvariantsHoldAfterAnyChanges) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed, "edits");
    Map map = ChainOfKeyFrames(3);
    std::vector<Map> copies;
    for (int i = 0; i < 300; ++i) {
      if (i % 100 == 50) copies.push_back(map);
      map.Apply({RandomChange(map, rng)});
      ASSERT_NO_THROW(map.CheckInvariants()) << "seed " << seed << ", change " << i;
    }
    for (const Map& copy : copies) EXPECT_NO_THROW(copy.CheckInvariants()) << "seed " << seed;
    for (std::int64_t id = 0; id < map.NextPointId().value; ++id) {
      const PointId current = map.Current(PointId{id});
      EXPECT_TRUE(!current.valid() || map.Find(current) != nullptr);
    }
    for (std::int64_t id = 0; id < map.NextKeyFrameId().value; ++id) {
      EXPECT_NO_THROW(map.PoseOf(KeyFrameId{id}));
    }
    EXPECT_GT(map.points().size() + map.lines().size(), 5U);  // the test is not about an empty map
  }
}

// A copy is what the map was, while another thread reads it.
TEST(Map, ACopyStaysWhatItIs) {
  Rng rng(1, "edits");
  Map map = ChainOfKeyFrames(3);
  for (int i = 0; i < 200; ++i) map.Apply({RandomChange(map, rng)});
  const std::size_t points = map.points().size(), lines = map.lines().size();
  const Map copy = map;
  std::thread reader([&] {
    for (int i = 0; i < 50; ++i) copy.CheckInvariants();
  });
  for (int i = 0; i < 200; ++i) map.Apply({RandomChange(map, rng)});
  reader.join();
  EXPECT_EQ(copy.points().size(), points);
  EXPECT_EQ(copy.lines().size(), lines);
  EXPECT_NE(map.version(), copy.version());
}

}  // namespace
}  // namespace plumbline
