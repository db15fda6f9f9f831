// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/relative_pose.h"

#include "plumbline/base/random.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/solvers/epipolar_cost.h"

#include "tests/solvers/two_view_scene.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

using testing::AngleBetween;
using testing::MakeTwoViewScene;
using testing::SceneKind;
using testing::TwoViewOptions;
using testing::TwoViewScene;

std::vector<RelativePoseHypothesis> Estimate(const TwoViewScene& scene,
                                             RelativePoseMethod method,
                                             std::span<const Rigid3> guesses = {}) {
  Rng rng(1, "relative_pose");
  return EstimateRelativePoses(scene.matches, {.method = method}, rng, guesses);
}

bool IsRight(const RelativePoseHypothesis& h, const TwoViewScene& scene, double max_direction) {
  return AngularDistance(h.b_from_a.rotation, scene.b_from_a.rotation) < 0.6 * kDegree &&
         AngleBetween(h.b_from_a.translation, scene.b_from_a.translation) < max_direction;
}

// Scenes of 40 in which a hypothesis, and the first one, is right.
struct Found {
  int any = 0;
  int first = 0;
};
Found CountFound(SceneKind kind, RelativePoseMethod method, double max_direction) {
  Found found;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const TwoViewScene scene =
        MakeTwoViewScene(seed, {.kind = kind, .outliers = 0.2, .sigma = 0.5 / 500});
    const auto all = Estimate(scene, method);
    const auto right = [&](const auto& h) { return IsRight(h, scene, max_direction); };
    found.any += std::any_of(all.begin(), all.end(), right) ? 1 : 0;
    found.first += !all.empty() && right(all.front()) ? 1 : 0;
  }
  return found;
}

TEST(EstimateRelativePoses, FindsThePoseInAllKindsOfScenes) {
  const auto method = RelativePoseMethod::kFivePoint;
  EXPECT_EQ(CountFound(SceneKind::kGeneral, method, 3 * kDegree).first, 40);
  EXPECT_EQ(CountFound(SceneKind::kForward, method, 3 * kDegree).first, 40);
  EXPECT_GE(CountFound(SceneKind::kLowParallax, method, 12 * kDegree).any, 39);
  // The other solution of the plane may be first; it must not be the only one.
  EXPECT_GE(CountFound(SceneKind::kPlane, method, 5 * kDegree).any, 38);
}

TEST(EstimateRelativePoses, EightPointsServeInSpaceAndFailOnPlanes) {
  const auto method = RelativePoseMethod::kEightPoint;
  EXPECT_EQ(CountFound(SceneKind::kGeneral, method, 3 * kDegree).first, 40);
  EXPECT_LT(CountFound(SceneKind::kPlane, method, 5 * kDegree).any, 20);
}

TEST(EstimateRelativePoses, KeepsBothSolutionsOfAPlane) {
  int both = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(
        seed, {.kind = SceneKind::kTwofoldPlane, .outliers = 0.1, .sigma = 0.5 / 500});
    const auto all = Estimate(scene, RelativePoseMethod::kFivePoint);
    if (all.size() < 2) continue;
    const bool first = IsRight(all[0], scene, 5 * kDegree);
    both += first != IsRight(all[1], scene, 5 * kDegree) ? 1 : 0;
    EXPECT_GT(all[1].in_front, 0.9 * all[1].inliers);
  }
  EXPECT_GE(both, 18);
}

TEST(EstimateRelativePoses, DropsTheSolutionOfAPlaneWithPointsBehind) {
  const TwoViewScene scene =
      MakeTwoViewScene(1, {.kind = SceneKind::kPlane, .noise = 0.1, .sigma = 0.5 / 500});
  const auto all = Estimate(scene, RelativePoseMethod::kFivePoint);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(IsRight(all.front(), scene, 1 * kDegree));
}

TEST(EstimateRelativePoses, WhatIsSaidOfAHypothesisIsTrue) {
  const TwoViewScene scene = MakeTwoViewScene(3, {.outliers = 0.2});
  const auto all = Estimate(scene, RelativePoseMethod::kFivePoint);
  ASSERT_FALSE(all.empty());
  for (const RelativePoseHypothesis& h : all) {
    EXPECT_NEAR(h.b_from_a.translation.norm(), 1, 1e-12);
    ASSERT_EQ(h.is_inlier.size(), scene.matches.size());
    double cost = 0;
    int in_front = 0;
    for (std::size_t i = 0; i < scene.matches.size(); ++i) {
      const double chi2 = SampsonChi2(EssentialMatrix(h.b_from_a), scene.matches[i]);
      EXPECT_EQ(h.is_inlier[i], chi2 < kChi2OneDof95);
      cost += std::min(chi2, kChi2OneDof95);
      in_front += h.is_inlier[i] && IsInFront(h.b_from_a, scene.matches[i]) ? 1 : 0;
    }
    EXPECT_NEAR(h.cost, cost, 1e-9);
    EXPECT_EQ(h.in_front, in_front);
    EXPECT_EQ(h.inliers, std::count(h.is_inlier.begin(), h.is_inlier.end(), true));
  }
  EXPECT_NEAR(all.front().inliers, 0.8 * 0.95 * 300, 25);
}

TEST(EstimateRelativePoses, AGuessIsEnoughWithoutSamples) {
  const TwoViewScene scene = MakeTwoViewScene(3, {.outliers = 0.2});
  Rigid3 guess = scene.b_from_a;
  guess.rotation = ExpSo3({0.005, -0.005, 0.003}) * guess.rotation;
  guess.translation = 7 * guess.translation;
  Rng rng(1);
  const auto all =
      EstimateRelativePoses(scene.matches,
                            {.method = RelativePoseMethod::kEightPoint, .max_iterations = 1},
                            rng,
                            std::array{guess});
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(IsRight(all.front(), scene, 3 * kDegree));
}

TEST(EstimateRelativePoses, SameSeedSameBytes) {
  const TwoViewScene scene = MakeTwoViewScene(3, {.outliers = 0.3});
  const auto first = Estimate(scene, RelativePoseMethod::kFivePoint);
  const auto second = Estimate(scene, RelativePoseMethod::kFivePoint);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].b_from_a.rotation.coeffs(), second[i].b_from_a.rotation.coeffs());
    EXPECT_EQ(first[i].b_from_a.translation, second[i].b_from_a.translation);
  }
}

TEST(EstimateRelativePoses, TooFewMatchesGiveNothing) {
  const TwoViewScene scene = MakeTwoViewScene(3, {.points = 3});
  EXPECT_TRUE(Estimate(scene, RelativePoseMethod::kFivePoint).empty());
  EXPECT_TRUE(Estimate({}, RelativePoseMethod::kEightPoint).empty());
}

TEST(IsInFront, HoldsForOneOfTheFourPoses) {
  const TwoViewScene scene = MakeTwoViewScene(5, {.points = 50, .noise = 0});
  const Rigid3& truth = scene.b_from_a;
  const Eigen::Quaterniond half_turn(
      Eigen::AngleAxisd(std::numbers::pi, truth.translation.normalized()));
  for (const RayMatch& match : scene.matches) {
    EXPECT_TRUE(IsInFront(truth, match));
    EXPECT_FALSE(IsInFront({truth.rotation, -truth.translation}, match));
    EXPECT_FALSE(IsInFront({half_turn * truth.rotation, truth.translation}, match));
    EXPECT_FALSE(IsInFront({half_turn * truth.rotation, -truth.translation}, match));
  }
}

constexpr double kPairwiseSigma = 1e-3;

// Matches of points of a volume in front of both cameras; every `wrong`-th one is a wrong match.
std::vector<RayMatch> MakePairwiseMatches(const Rigid3& b_from_a,
                                          double noise,
                                          int wrong,
                                          bool plane = false) {
  Rng rng(5, "pairwise");
  std::vector<RayMatch> matches;
  for (int i = 0; i < 200; ++i) {
    const double z = plane ? 4 : rng.Uniform(2, 8);
    const Eigen::Vector3d in_a(z * rng.Uniform(-0.5, 0.5), z * rng.Uniform(-0.4, 0.4), z);
    RayMatch match{
        in_a.hnormalized(), (b_from_a * in_a).hnormalized(), kPairwiseSigma, kPairwiseSigma};
    for (int k = 0; k < 2; ++k) {
      match.a(k) += noise * rng.Normal();
      match.b(k) += noise * rng.Normal();
    }
    if (wrong > 0 && i % wrong == 0) match.b += Eigen::Vector2d(0.1, rng.Uniform(-0.2, 0.2));
    matches.push_back(match);
  }
  return matches;
}

const Rigid3 kPairwiseTruth{ExpSo3({0.02, -0.05, 0.03}), Eigen::Vector3d(0.5, -0.2, 0.3)};

double PairwiseDirectionErrorDeg(const Rigid3& found, const Rigid3& truth) {
  return std::acos(std::clamp(found.translation.dot(truth.translation.normalized()), -1.0, 1.0)) *
         180 / M_PI;
}

TEST(EstimatePairwisePose, IsExactWithoutNoise) {
  Rng rng(1);
  const auto pose = EstimatePairwisePose(MakePairwiseMatches(kPairwiseTruth, 0, 0), rng);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->b_from_a.rotation.angularDistance(kPairwiseTruth.rotation), 1e-9);
  EXPECT_LT(PairwiseDirectionErrorDeg(pose->b_from_a, kPairwiseTruth), 1e-5);  // with its sign
  EXPECT_NEAR(pose->b_from_a.translation.norm(), 1, 1e-12);
}

TEST(EstimatePairwisePose, FindsThePoseAmongWrongMatches) {
  Rng rng(2);
  const auto matches = MakePairwiseMatches(kPairwiseTruth, kPairwiseSigma, 5);
  const auto pose = EstimatePairwisePose(matches, rng);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->b_from_a.rotation.angularDistance(kPairwiseTruth.rotation), 0.01);
  EXPECT_LT(PairwiseDirectionErrorDeg(pose->b_from_a, kPairwiseTruth), 5);
  ASSERT_EQ(pose->is_inlier.size(), matches.size());
  int kept = 0, wrong_kept = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    kept += pose->is_inlier[i] && i % 5 != 0;
    wrong_kept += pose->is_inlier[i] && i % 5 == 0;
  }
  EXPECT_GT(kept, 120);
  EXPECT_LT(wrong_kept, 8);
}

TEST(EstimatePairwisePose, NeedsEightMatches) {
  Rng rng(3);
  auto matches = MakePairwiseMatches(kPairwiseTruth, 0, 0);
  matches.resize(7);
  EXPECT_FALSE(EstimatePairwisePose(matches, rng));
}

TEST(TranslationFromTwoPoints, IsTheDirectionUpToItsSign) {
  const auto matches = MakePairwiseMatches(kPairwiseTruth, 0, 0);
  const std::array<RayMatch, 2> pair = {matches[3], matches[17]};
  const auto t = TranslationFromTwoPoints(kPairwiseTruth.rotation, pair);
  ASSERT_TRUE(t);
  EXPECT_LT(t->cross(kPairwiseTruth.translation.normalized()).norm(), 1e-9);
  const std::array<RayMatch, 2> same = {matches[3], matches[3]};
  EXPECT_FALSE(TranslationFromTwoPoints(kPairwiseTruth.rotation, same));
}

// Of true matches, 83 of 100 have both distances below the 95 % limit.
TEST(IsNearEpipolarLines, KeepsMostTrueMatches) {
  const auto matches = MakePairwiseMatches(kPairwiseTruth, kPairwiseSigma, 0);
  const Eigen::Matrix3d E = EssentialMatrix(kPairwiseTruth);
  const auto near = std::count_if(
      matches.begin(), matches.end(), [&](const RayMatch& m) { return IsNearEpipolarLines(E, m); });
  EXPECT_GT(near, 150);
  EXPECT_LT(near, 185);
}

}  // namespace

}  // namespace plumbline
