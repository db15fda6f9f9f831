// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/verify_loop.h"

#include "tests/loop_closing/loop_scene.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace verify_loop_test {

using testing::LoopScene;
using testing::LoopSceneOptions;
using testing::MakeLoopScene;

constexpr KeyFrameId kQuery{43};
constexpr KeyFrameId kCandidate{3};  // at the same place a round before

Similarity3 TruePose(const LoopScene& scene, KeyFrameId query, KeyFrameId candidate) {
  return ToSimilarity(scene.truth[static_cast<std::size_t>(candidate.value)] *
                      Inverse(scene.truth[static_cast<std::size_t>(query.value)]));
}

Expected<LoopEdge, LoopRefusal> Verify(const LoopScene& scene,
                                       KeyFrameId query = kQuery,
                                       KeyFrameId candidate = kCandidate,
                                       const LoopVerificationOptions& options = {}) {
  return VerifyLoop(scene.map, query, scene.map, candidate, scene.Imaging(), options);
}

double Error(const Similarity3& a, const Similarity3& b) { return LogSim3(a * Inverse(b)).norm(); }

TEST(VerifyLoop, FindsTheRelativePoseOfAPlaceSeenAgain) {
  LoopSceneOptions options;
  options.drift = testing::GrowingDrift;
  const LoopScene scene = MakeLoopScene(options);
  const auto edge = Verify(scene, kQuery, KeyFrameId{4});
  ASSERT_TRUE(edge) << NameOf(edge.error());
  EXPECT_EQ(edge->query, kQuery);
  EXPECT_EQ(edge->candidate, KeyFrameId{4});
  EXPECT_EQ(edge->candidate_from_query.scale, 1);
  EXPECT_LT(Error(edge->candidate_from_query, TruePose(scene, kQuery, KeyFrameId{4})), 0.02);
  EXPECT_GT(edge->points.size(), 100U);
  EXPECT_GT(edge->lines.size(), 10U);
  EXPECT_LT(edge->evidence.log10_chance, -50);
  EXPECT_GE(edge->evidence.confirmed, 2);
}

TEST(VerifyLoop, PairsAreTheSameThing) {
  const LoopScene scene = MakeLoopScene({});
  const auto edge = Verify(scene);
  ASSERT_TRUE(edge);
  int wrong = 0;
  for (const auto& pair : edge->points) {
    wrong += (scene.map.Find(pair.in_query)->position - scene.map.Find(pair.in_candidate)->position)
                 .norm() > 1e-9;
  }
  EXPECT_LE(wrong, 1);
  for (const auto& pair : edge->lines) {
    const PluckerLine& line = scene.map.Find(pair.in_query)->line;
    EXPECT_LT((line.direction - scene.map.Find(pair.in_candidate)->line.direction).norm(), 1e-9);
  }
}

TEST(VerifyLoop, FindsTheScaleWithOneCamera) {
  LoopSceneOptions options;
  options.sensor.depth = false;
  options.drift = testing::ShrinkingDrift;
  const LoopScene scene = MakeLoopScene(options);
  const auto edge = Verify(scene);
  ASSERT_TRUE(edge) << NameOf(edge.error());
  const double scale = std::pow(0.9, 3 / 40.0) / std::pow(0.9, 43 / 40.0);
  EXPECT_NEAR(edge->candidate_from_query.scale, scale, 0.01);
  EXPECT_GT(edge->covariance(6, 6), 0);
}

TEST(VerifyLoop, DoesWithLinesAndFewPoints) {
  LoopSceneOptions options;
  options.points = 60;
  options.lines = 400;
  options.drift = testing::GrowingDrift;
  const LoopScene scene = MakeLoopScene(options);
  const auto edge = Verify(scene);
  ASSERT_TRUE(edge) << NameOf(edge.error());
  EXPECT_GT(edge->evidence.inlier_lines, edge->evidence.inlier_points);
  EXPECT_LT(Error(edge->candidate_from_query, TruePose(scene, kQuery, kCandidate)), 0.03);
}

TEST(VerifyLoop, DoesWithLinesAlone) {
  LoopSceneOptions options;
  options.lines = 400;
  options.sensor.points = false;
  const LoopScene scene = MakeLoopScene(options);
  const auto edge = Verify(scene);
  ASSERT_TRUE(edge) << NameOf(edge.error());
  EXPECT_LT(Error(edge->candidate_from_query, TruePose(scene, kQuery, kCandidate)), 0.03);
}

TEST(VerifyLoop, RefusesAnotherPlace) {
  const LoopScene scene = MakeLoopScene({});
  for (const std::int64_t other : {10, 15, 20, 25, 30}) {
    const auto edge = Verify(scene, kQuery, KeyFrameId{other});
    ASSERT_FALSE(edge) << other;
    EXPECT_TRUE(edge.error() == LoopRefusal::kFewMatches ||
                edge.error() == LoopRefusal::kNoAgreement)
        << NameOf(edge.error());
  }
}

// All points of a wall look the same but for its rows.
TEST(VerifyLoop, RefusesWhatRepeatsInTheImage) {
  LoopSceneOptions options;
  options.alike_sectors = 60;
  options.lines = 0;
  const LoopScene scene = MakeLoopScene(options);
  const auto edge = Verify(scene);
  ASSERT_FALSE(edge);
}

TEST(VerifyLoop, RefusesOneThingSeenInTwoPlaces) {
  LoopSceneOptions options;
  options.lines = 0;
  options.poster_points = 80;
  const LoopScene scene = MakeLoopScene(options);
  LoopVerificationOptions lenient;
  lenient.max_rotation_sigma_deg = 10;
  lenient.max_translation_sigma = 1;
  const auto edge = Verify(scene, KeyFrameId{20}, KeyFrameId{3}, lenient);
  ASSERT_FALSE(edge);
  EXPECT_EQ(edge.error(), LoopRefusal::kNarrow) << NameOf(edge.error());
}

TEST(VerifyLoop, AsksTheNeighbours) {
  const LoopScene scene = MakeLoopScene({});
  LoopVerificationOptions options;
  options.max_confirming_log10_chance = -1000;  // nobody can confirm so much
  const auto edge = Verify(scene, kQuery, kCandidate, options);
  ASSERT_FALSE(edge);
  EXPECT_EQ(edge.error(), LoopRefusal::kUnconfirmed);
}

TEST(VerifyLoop, NeedsMatches) {
  const LoopScene scene = MakeLoopScene({});
  LoopVerificationOptions options;
  options.min_matches = 10000;
  EXPECT_EQ(Verify(scene, kQuery, kCandidate, options).error(), LoopRefusal::kFewMatches);
}

TEST(VerifyLoop, NeedsInliers) {
  const LoopScene scene = MakeLoopScene({});
  LoopVerificationOptions options;
  options.min_inliers = 10000;
  EXPECT_EQ(Verify(scene, kQuery, kCandidate, options).error(), LoopRefusal::kFewInliers);
}

TEST(VerifyLoop, NeedsMoreThanChance) {
  const LoopScene scene = MakeLoopScene({});
  LoopVerificationOptions options;
  options.max_log10_chance = -1e6;
  EXPECT_EQ(Verify(scene, kQuery, kCandidate, options).error(), LoopRefusal::kChance);
}

TEST(VerifyLoop, NeedsATightPose) {
  const LoopScene scene = MakeLoopScene({});
  LoopVerificationOptions options;
  options.max_rotation_sigma_deg = 1e-9;
  EXPECT_EQ(Verify(scene, kQuery, kCandidate, options).error(), LoopRefusal::kLoose);
}

TEST(VerifyLoop, OfTwoMaps) {
  const LoopScene one = MakeLoopScene({});
  LoopSceneOptions options;
  options.drift = [](int) { return ToSimilarity({ExpSo3({0.3, -1, 0.2}), {5, 6, 7}}); };
  const LoopScene other = MakeLoopScene(options);
  const KeyFrameId query{5};
  const auto edge = VerifyLoop(other.map, query, one.map, query, one.Imaging(), {});
  ASSERT_TRUE(edge) << NameOf(edge.error());
  EXPECT_LT(Error(edge->candidate_from_query, Similarity3{}), 0.01);
  const Similarity3 worlds = CandidateWorldFromQueryWorld(other.map, one.map, *edge);
  EXPECT_LT(Error(worlds, Inverse(options.drift(0))), 0.05);
}

TEST(VerifyLoop, GivesTheSameEveryTime) {
  const LoopScene scene = MakeLoopScene({});
  const auto a = Verify(scene);
  const auto b = Verify(scene);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->candidate_from_query.translation, b->candidate_from_query.translation);
  EXPECT_EQ(a->covariance, b->covariance);
  EXPECT_EQ(a->points, b->points);
  EXPECT_EQ(a->lines, b->lines);
}

}  // namespace verify_loop_test
}  // namespace plumbline
