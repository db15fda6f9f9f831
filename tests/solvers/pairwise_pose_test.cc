// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/pairwise_pose.h"

#include "plumbline/base/random.h"
#include "plumbline/geometry/epipolar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

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
