// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/essential_graph.h"

#include "plumbline/base/random.h"
#include "plumbline/loop_closing/pairwise_consistency.h"
#include "plumbline/map/covisibility.h"

#include "tests/loop_closing/loop_scene.h"
#include "tests/map/map_fixture.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;

LoopEdge TrueEdge(const LoopScene& scene, std::int64_t query, std::int64_t candidate) {
  LoopEdge edge;
  edge.query = KeyFrameId{query};
  edge.candidate = KeyFrameId{candidate};
  edge.candidate_from_query =
      ToSimilarity(scene.map.PoseOf(edge.candidate) * Inverse(scene.map.PoseOf(edge.query)));
  edge.covariance.diagonal().head<6>().setConstant(1e-4);
  return edge;
}

TEST(EssentialGraph, TiesParentsAndStrongNeighbours) {
  const LoopScene scene = MakeLoopScene({});
  const EssentialGraph sparse = MakeEssentialGraph(scene.map, false, {}, 100000);
  ASSERT_EQ(sparse.keyframes.size(), 46U);
  const PoseGraph graph = sparse.WithAllEdges();
  ASSERT_EQ(graph.poses.size(), 46U);
  EXPECT_EQ(graph.edges.size(), 45U);
  EXPECT_TRUE(graph.fixed.front());
  EXPECT_FALSE(graph.fixed.back());
  for (const PoseGraphEdge& edge : graph.edges) {
    EXPECT_EQ(edge.to, edge.from + 1);
    EXPECT_LT(PoseGraphResidual(edge,
                                graph.poses[static_cast<std::size_t>(edge.to)],
                                graph.poses[static_cast<std::size_t>(edge.from)])
                  .norm(),
              1e-9);
  }
  const EssentialGraph dense = MakeEssentialGraph(scene.map, false, {}, 60);
  EXPECT_GT(dense.WithAllEdges().edges.size(), 60U);
}

TEST(EssentialGraph, TiesAreInOrderEachOnce) {
  LoopScene scene = MakeLoopScene({});
  scene.map.Apply({edit::RemoveKeyFrame{KeyFrameId{20}}, edit::RemoveKeyFrame{KeyFrameId{21}}});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, false, {}, 60);
  std::set<std::pair<int, int>> expected;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    const int pose = essential.PoseOf(id);
    const KeyFrameId parent = NearestAncestor(scene.map, keyframe.parent);
    if (parent.valid()) expected.emplace(pose, essential.PoseOf(parent));
    for (const CovisibleKeyFrame& other : Covisible(scene.map, id, 60)) {
      if (other.id < id) expected.emplace(pose, essential.PoseOf(other.id));
    }
  }
  EXPECT_EQ(essential.ties, (std::vector<std::pair<int, int>>(expected.begin(), expected.end())));
}

TEST(EssentialGraph, PassesOverKeyFramesThatLeft) {
  LoopScene scene = MakeLoopScene({});
  scene.map.Apply({edit::RemoveKeyFrame{KeyFrameId{20}}, edit::RemoveKeyFrame{KeyFrameId{21}}});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, false, {}, 100000);
  EXPECT_EQ(essential.keyframes.size(), 44U);
  EXPECT_EQ(essential.ties.size(), 43U);
  EXPECT_EQ(essential.PoseOf(KeyFrameId{20}), -1);
  EXPECT_EQ(essential.keyframes[static_cast<std::size_t>(essential.PoseOf(KeyFrameId{22}))],
            KeyFrameId{22});
}

void ExpectSameBits(const PoseWithCovariance& a, const PoseWithCovariance& b) {
  EXPECT_EQ(a.pose.scale, b.pose.scale);
  EXPECT_EQ(a.pose.rotation.coeffs(), b.pose.rotation.coeffs());
  EXPECT_EQ(a.pose.translation, b.pose.translation);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(EssentialGraph, HasTheBitsOfANewOneWhereTheMapWasFollowed) {
  LoopSceneOptions options;
  options.keyframes = 80;
  options.drift = testing::GrowingDrift;
  LoopScene scene = MakeLoopScene(options);
  StrongCovisibility covisible(60);
  covisible.Follow(scene.map);
  const auto before = MakeEssentialGraph(scene.map, covisible, true, {}).ties;
  edit::MoveKeyFrames motion;
  for (int i = 0; i < 80; ++i) motion.new_from_old[KeyFrameId{i}] = testing::ShrinkingDrift(i);
  MapEdit edit{edit::RemoveKeyFrame{KeyFrameId{20}}, edit::RemoveKeyFrame{KeyFrameId{70}}, motion};
  for (std::int64_t i = 0; i < 30; ++i) {
    edit.push_back(edit::MergePoints{PointId{i}, PointId{i + 200}});
  }
  scene.map.Apply(edit);
  covisible.Follow(scene.map);
  const EssentialGraph kept = MakeEssentialGraph(scene.map, covisible, true, {});
  const EssentialGraph anew = MakeEssentialGraph(scene.map, true, {}, 60);
  EXPECT_NE(kept.ties, before);
  EXPECT_EQ(kept.ties, anew.ties);
  EXPECT_EQ(kept.usual_length, anew.usual_length);
  OdometryWays kept_ways(kept), ways(anew);
  for (const int other : {0, 5, 30, 60}) {
    const auto way = kept_ways.Along(77, other);
    const auto expected = ways.Along(77, other);
    ASSERT_TRUE(way && expected);
    ExpectSameBits(*way, *expected);
  }
  const auto a = LoopAsEdge(scene.map, kept, TrueEdge(scene, 79, 3));
  const auto b = LoopAsEdge(scene.map, kept, TrueEdge(scene, 45, 5));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(CycleChi2(kept_ways, *a, *b), CycleChi2(ways, *a, *b));
}

TEST(EssentialGraph, KnowsTheScaleWorseWhereTheCameraTurns) {
  const LoopScene scene = MakeLoopScene({});
  const DriftOptions drift{.log_scale = 0.02, .log_scale_per_turn = 0.1};
  const EssentialGraph essential = MakeEssentialGraph(scene.map, true, drift, 100000);
  double most = 0;
  const PoseGraph graph = essential.WithAllEdges();
  for (const PoseGraphEdge& edge : graph.edges) {
    const double angle = LogSo3(edge.to_from.rotation).norm();
    most = std::max(most, angle);
    EXPECT_NEAR(1 / edge.information(6, 6), 0.02 * 0.02 + 0.1 * 0.1 * angle * angle, 1e-12);
  }
  EXPECT_GT(most, 0.05);
  const PoseGraph rigid = MakeEssentialGraph(scene.map, false, drift, 100000).WithAllEdges();
  EXPECT_EQ(rigid.edges.size(), graph.edges.size());
  for (const PoseGraphEdge& edge : rigid.edges) EXPECT_EQ(edge.information(6, 6), 0);
}

TEST(ShareInformation, MakesAPathWithShortcutsAsStiffAsOneWithout) {
  // Of edges over one, two and three steps, six lead from any pose to what comes after it.
  PoseGraph graph;
  graph.poses.resize(60);
  for (int i = 0; i < 60; ++i) {
    for (int k = 1; k <= std::min(3, i); ++k) {
      graph.edges.push_back({i, i - k, {}, Matrix7d::Identity(), false});
    }
  }
  ShareInformation(graph);
  double across = 0;
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.to >= 30 && edge.from < 30) across += edge.information(0, 0);
  }
  EXPECT_NEAR(across, 1, 1e-9);
  PoseGraph chain;
  chain.poses.resize(3);
  for (int i = 1; i < 3; ++i) chain.edges.push_back({i, i - 1, {}, Matrix7d::Identity(), false});
  ShareInformation(chain);
  EXPECT_EQ(chain.edges.front().information, Matrix7d::Identity());
}

TEST(LoopAsEdge, StandsForKeyFramesThatLeft) {
  LoopScene scene = MakeLoopScene({});
  const LoopEdge loop = TrueEdge(scene, 44, 4);
  scene.map.Apply({edit::RemoveKeyFrame{KeyFrameId{44}}});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, false, {}, 60);
  const auto edge = LoopAsEdge(scene.map, essential, loop);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->from, essential.PoseOf(KeyFrameId{43}));
  EXPECT_TRUE(edge->may_be_wrong);
  EXPECT_LT(PoseGraphResidual(*edge,
                              essential.poses[static_cast<std::size_t>(edge->to)],
                              essential.poses[static_cast<std::size_t>(edge->from)])
                .norm(),
            1e-9);
}

TEST(LoopAsEdge, FollowsUnits) {
  LoopScene scene = MakeLoopScene({});
  const LoopEdge loop = TrueEdge(scene, 44, 4);
  edit::MoveKeyFrames motion;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    motion.new_from_old[id] = {0.5, ExpSo3({0, 0.3, 0}), {1, 2, 3}};
  }
  scene.map.Apply({motion});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, true, {}, 60);
  const auto edge = LoopAsEdge(scene.map, essential, loop);
  ASSERT_TRUE(edge);
  EXPECT_LT(PoseGraphResidual(*edge,
                              essential.poses[static_cast<std::size_t>(edge->to)],
                              essential.poses[static_cast<std::size_t>(edge->from)])
                .norm(),
            1e-9);
}

TEST(OdometryWays, IsThePoseOfTheMapWithDriftThatGrows) {
  const LoopScene scene = MakeLoopScene({});
  const EssentialGraph essential = MakeEssentialGraph(scene.map, false, {}, 100000);
  OdometryWays odometry(essential);
  double before = 0;
  for (const int other : {1, 5, 20, 40}) {
    const auto way = odometry.Along(0, other);
    ASSERT_TRUE(way);
    const Similarity3 direct =
        essential.poses[0] * Inverse(essential.poses[static_cast<std::size_t>(other)]);
    EXPECT_LT(LogSim3(way->pose * Inverse(direct)).norm(), 1e-9);
    const double drift = way->covariance.topLeftCorner<6, 6>().trace();
    EXPECT_GT(drift, before);
    before = drift;
    const auto back = odometry.Along(other, 0);
    EXPECT_LT(LogSim3(back->pose * way->pose).norm(), 1e-9);
  }
}

TEST(OdometryWays, IsNothingWhereNoEdgesLead) {
  EssentialGraph essential;
  essential.keyframes = {KeyFrameId{0}, KeyFrameId{1}};
  essential.poses.resize(2);
  OdometryWays odometry(essential);
  EXPECT_FALSE(odometry.Along(0, 1));
  EXPECT_TRUE(odometry.Along(1, 1));
}

}  // namespace

namespace strong_covisibility_test {

constexpr int kStrong = 4;
constexpr KeyFrameId kEarly{3}, kMiddle{70}, kLate{140};  // on three pages
using Ids = std::vector<KeyFrameId>;

// Compares the pairs with those of Covisible(). Returns how many there are.
int ExpectAllPairs(const StrongCovisibility& covisible, const Map& map) {
  int pairs = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    Ids expected;
    for (const CovisibleKeyFrame& other : Covisible(map, id, kStrong)) {
      if (other.id < id) expected.push_back(other.id);
    }
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(covisible.EarlierOf(id), expected) << id.value;
    pairs += static_cast<int>(expected.size());
  }
  return pairs;
}

// Makes and changes maps at random.
class Editor {
 public:
  std::size_t Draw(std::size_t count) { return rng_.Index(count); }

  Map Start() {
    Map map = ChainOfKeyFrames(kKeyFrames);
    for (int i = 0; i < 400; ++i) AddPoint(map);
    for (int i = 0; i < 100; ++i) AddLine(map);
    return map;
  }

  void Change(Map& map) {
    const KeyFrameId keyframe = AnyOf(map.keyframes());
    const PointId point = AnyOf(map.points());
    const LineId line = AnyOf(map.lines());
    switch (Draw(11)) {
      case 0:
        return AddKeyFrame(map);
      case 1:
        return map.Apply({edit::RemoveKeyFrame{keyframe}});
      case 2:
        return AddPoint(map);
      case 3:
        return AddLine(map);
      case 4:
        return map.Apply({edit::AddPointObservation{point, keyframe, AnyFeature()}});
      case 5:
        return map.Apply({edit::AddLineObservation{line, keyframe, AnyFeature()}});
      case 6:
        return map.Apply({edit::RemovePointObservation{point, ObserverOf(map, point)}});
      case 7:
        return map.Apply({edit::MergePoints{point, AnyOf(map.points())}});
      case 8:
        return map.Apply({edit::MergeLines{line, AnyOf(map.lines())}});
      case 9:
        return map.Apply({edit::RemovePoint{point}});
      default:
        return map.Apply({edit::SetPose{keyframe, {}}});
    }
  }

 private:
  static constexpr std::int64_t kKeyFrames = 200;

  template <class Id, class T>
  Id AnyOf(const IdTable<Id, T>& table) {
    const std::int64_t first = table.begin()->first.value;
    const std::int64_t last = table.rbegin()->first.value;
    const std::size_t drawn = Draw(static_cast<std::size_t>(last - first) + 1);
    return table.lower_bound(Id{first + static_cast<std::int64_t>(drawn)})->first;
  }

  int AnyFeature() { return static_cast<int>(Draw(kFeatures)); }

  KeyFrameId ObserverOf(const Map& map, PointId id) {
    const Observations& seen = map.Find(id)->observations;
    return (seen.begin() + static_cast<std::ptrdiff_t>(Draw(seen.size())))->first;
  }

  // Returns observations by keyframes side by side, and now and then by others half a map away.
  Observations Seen(const Map& map) {
    Observations seen;
    const std::int64_t first = AnyOf(map.keyframes()).value;
    const bool twice = Draw(3) == 0;
    for (std::int64_t k = first; k < first + 8; ++k) {
      seen.emplace(KeyFrameId{k}, AnyFeature());
      if (twice) seen.emplace(KeyFrameId{(k + kKeyFrames / 2) % kKeyFrames}, AnyFeature());
    }
    return seen;
  }

  void AddPoint(Map& map) {
    map.Apply({edit::AddPoint{PointSeenBy(map.NextPointId().value, Seen(map))}});
  }

  void AddLine(Map& map) {
    map.Apply({edit::AddLine{LineSeenBy(map.NextLineId().value, Seen(map))}});
  }

  void AddKeyFrame(Map& map) {
    KeyFrame keyframe =
        BlankKeyFrame(map.NextKeyFrameId().value, map.keyframes().rbegin()->first.value);
    for (PointId& match : keyframe.frame.points) match = AnyOf(map.points());
    for (LineId& match : keyframe.frame.lines) match = AnyOf(map.lines());
    map.Apply({edit::AddKeyFrame{std::move(keyframe)}});
  }

  Rng rng_{7, "strong_covisibility_test"};
};

// Ten points that the early keyframe shows, and the middle and the late one with it.
Map OnThreePages() {
  Map map = ChainOfKeyFrames(150);
  for (int i = 0; i < 10; ++i) {
    map.Apply({edit::AddPoint{PointSeenBy(i, {{kEarly, i}, {kMiddle, i}, {kLate, i}})}});
  }
  return map;
}

// Leaves the early keyframe three of the ten points.
void TakeMostOfTheEarlyOnes(Map& map) {
  for (std::int64_t i = 0; i < 7; ++i) {
    map.Apply({edit::RemovePointObservation{PointId{i}, kEarly}});
  }
}

TEST(StrongCovisibility, HasAllPairsAfterAnyChanges) {
  constexpr int kRounds = 60;
  Editor editor;
  Map map = editor.Start();
  StrongCovisibility covisible(kStrong);
  std::vector<Map> earlier;
  int pairs = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t left = editor.Draw(12); left > 0; --left) editor.Change(map);
    if (round % 7 == 0) earlier.push_back(map);
    if (round % 10 == 9) map = earlier[editor.Draw(earlier.size())];
    covisible.Follow(map);
    pairs += ExpectAllPairs(covisible, map);
    ASSERT_FALSE(::testing::Test::HasFailure()) << round;
  }
  map.CheckInvariants();
  EXPECT_GT(pairs, 100 * kRounds);
}

TEST(StrongCovisibility, FollowsEarlierKeyFramesWherePagesOfLaterOnesStay) {
  Map map = OnThreePages();
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  const std::uint64_t before = map.keyframes().PageChanged(2);
  TakeMostOfTheEarlyOnes(map);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kMiddle});
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  map.Apply({edit::AddPointObservation{PointId{0}, kEarly, 0}});
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  EXPECT_EQ(map.keyframes().PageChanged(2), before);
}

// The copy has the id of the map, more versions and more changes, and its first page looks older
// than the last look at the map.
TEST(StrongCovisibility, KnowsACopyThatWentOnByItself) {
  Map map = OnThreePages();
  Map copy = map;
  TakeMostOfTheEarlyOnes(map);
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  for (int i = 0; i < 20; ++i) copy.Apply({edit::SetPose{kLate, {}}});
  EXPECT_GT(copy.version(), map.version());
  EXPECT_GT(copy.keyframes().changes(), map.keyframes().changes());
  EXPECT_LE(copy.keyframes().PageChanged(0), map.keyframes().changes());
  covisible.Follow(copy);
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  covisible.Follow(map);
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
}

TEST(StrongCovisibility, ForgetsPagesThatHaveGone) {
  Map map = OnThreePages();
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  for (std::int64_t id = 64; id < 128; ++id) map.Apply({edit::RemoveKeyFrame{KeyFrameId{id}}});
  ASSERT_EQ(map.keyframes().PageChanged(1), 0U);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kEarly});
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  covisible.Forget();
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kEarly});
}

TEST(StrongCovisibility, FollowsMapsThatAreJoined) {
  Map map = OnThreePages();
  Map other(MapId{1});
  other.ReserveIds(PointId{1000}, LineId{1000});
  for (std::int64_t id = 300; id < 304; ++id) {
    other.Apply({edit::AddKeyFrame{BlankKeyFrame(id, id == 300 ? -1 : id - 1)}});
  }
  for (int i = 0; i < 10; ++i) {
    other.Apply({edit::AddPoint{PointSeenBy(1000 + i, SeenBy(300, 303, i))}});
  }
  StrongCovisibility covisible(kStrong);
  covisible.Follow(other);
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), Ids{KeyFrameId{300}});
  covisible.Follow(map);
  map.Absorb(std::move(other), {});
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), Ids{KeyFrameId{300}});
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  for (std::int64_t i = 0; i < kStrong; ++i) {
    map.Apply({edit::MergePoints{PointId{i}, PointId{1000 + i}}});
  }
  covisible.Follow(map);
  map.CheckInvariants();
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), (Ids{kEarly, kMiddle, kLate, KeyFrameId{300}}));
  ExpectAllPairs(covisible, map);
}

}  // namespace strong_covisibility_test

}  // namespace plumbline
