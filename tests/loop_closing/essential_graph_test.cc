// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/essential_graph.h"

#include "plumbline/loop_closing/pairwise_consistency.h"
#include "plumbline/map/covisibility.h"

#include "tests/loop_closing/loop_scene.h"
#include <algorithm>
#include <cmath>
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
}  // namespace plumbline
