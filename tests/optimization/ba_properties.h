// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/bundle_adjustment.h"

#include "tests/optimization/ba_scene.h"
#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

namespace plumbline::testing {

// What holds of bundle adjustment with any kind of line. `solve`: as a BaSolver.

inline const StopCheck kGoOn = {};

inline double Error(const Rigid3& a, const Rigid3& b) { return LogSe3(a * Inverse(b)).norm(); }

inline double LargestPoseError(const BaResult& result, const BaProblem& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    largest = std::max(largest, Error(result.poses[i], truth.poses[i].cam_from_world));
  }
  return largest;
}

// Exactly the same numbers.
inline void ExpectSame(const Rigid3& a, const Rigid3& b) {
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(a.translation, b.translation);
}

template <class Solve>
void ExpectExactSceneWithoutNoise(const Solve& solve) {
  const BaScene scene = MakeBaScene(1, {});
  const BaResult result =
      solve(scene.problem, {.max_iterations = 50, .function_tolerance = 1e-12}, kGoOn);
  EXPECT_LT(LargestPoseError(result, scene.truth), 1e-9);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    EXPECT_LT((result.points[i] - scene.truth.points[i]).norm(), 1e-8) << i;
  }
  for (std::size_t i = 0; i < result.lines.size(); ++i) {
    const PluckerLine line = ToPlucker(result.lines[i]);
    const PluckerLine truth = ToPlucker(scene.truth.lines[i]);
    EXPECT_LT((line.moment - truth.moment).norm(), 1e-7) << i;
    EXPECT_LT((line.direction - truth.direction).norm(), 1e-8) << i;
  }
  EXPECT_EQ(std::count(result.point_inliers.begin(), result.point_inliers.end(), false), 0);
  EXPECT_EQ(std::count(result.line_inliers.begin(), result.line_inliers.end(), false), 0);
}

template <class Solve>
void ExpectSameBytesEveryTime(const Solve& solve) {
  const BaScene scene = MakeBaScene(15, {.weak_lines = 20, .sigma = 1, .outliers = 0.05});
  const BaResult a = solve(scene.problem, {}, kGoOn);
  const BaResult b = solve(scene.problem, {}, kGoOn);
  for (std::size_t i = 0; i < a.poses.size(); ++i) ExpectSame(a.poses[i], b.poses[i]);
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].U.coeffs(), b.lines[i].U.coeffs());
    EXPECT_EQ(a.lines[i].w, b.lines[i].w);
  }
  EXPECT_EQ(a.final_cost, b.final_cost);
}

// Told to end at its n-th question, it has the state of the steps until then.
template <class Solve>
void ExpectEndWhenItIsTold(const Solve& solve) {
  const BaScene scene = MakeBaScene(15, {.sigma = 1, .outliers = 0.05});
  const BaResult whole = solve(scene.problem, {}, [] { return false; });
  EXPECT_NE(whole.termination, BaTermination::kStopped);
  EXPECT_EQ(whole.final_cost, solve(scene.problem, {}, kGoOn).final_cost);
  for (const int questions : {0, 1, 2, 3}) {
    int asked = 0;
    const BaResult result = solve(scene.problem, {}, [&] { return asked++ >= questions; });
    EXPECT_EQ(result.termination, BaTermination::kStopped) << questions;
    EXPECT_LE(result.iterations, questions);
    EXPECT_LE(result.final_cost, result.initial_cost);
    ASSERT_EQ(result.poses.size(), scene.problem.poses.size());
    EXPECT_EQ(result.point_inliers.size(), scene.problem.point_observations.size());
    if (questions > 0) continue;
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
      ExpectSame(result.poses[i], scene.problem.poses[i].cam_from_world);
    }
  }
}

template <class Solve>
void ExpectUnseenLinesToStayBitByBit(const Solve& solve) {
  BaScene scene = MakeBaScene(16, {.points = 100, .lines = 20, .sigma = 1});
  scene.problem.lines.push_back(ToOrthonormal(LineThroughPoints({1, 1, 1}, {2, 1.5, 1})));
  const BaResult result = solve(scene.problem, {}, kGoOn);
  EXPECT_EQ(result.lines.back().U.coeffs(), scene.problem.lines.back().U.coeffs());
  EXPECT_EQ(result.lines.back().w, scene.problem.lines.back().w);
}

inline double LineAngle(const OrthonormalLine& a, const OrthonormalLine& b) {
  return ToPlucker(a).direction.cross(ToPlucker(b).direction).norm();
}

template <class Solve>
void ExpectLinesHeldParallel(const Solve& solve) {
  BaScene scene = MakeBaScene(31, {.sigma = 1});
  const BaResult without = solve(scene.problem, {}, kGoOn);
  for (std::size_t i = 0; i < scene.truth.lines.size(); ++i) {
    const double sense = i % 2 == 0 ? 1 : -1;
    scene.problem.axes.push_back(sense * ToPlucker(scene.truth.lines[i]).direction);
    scene.problem.parallel_lines.push_back({static_cast<int>(i), static_cast<int>(i), 2e-3});
  }
  const BaResult with = solve(scene.problem, {}, kGoOn);
  EXPECT_EQ(with.poses.size(), scene.problem.poses.size());
  EXPECT_EQ(with.line_inliers.size(), scene.problem.line_observations.size());
  EXPECT_EQ(with.line_chi2.size(), scene.problem.line_observations.size());
  double error_without = 0;
  double error_with = 0;
  for (std::size_t i = 0; i < scene.truth.lines.size(); ++i) {
    error_without += LineAngle(without.lines[i], scene.truth.lines[i]);
    error_with += LineAngle(with.lines[i], scene.truth.lines[i]);
  }
  EXPECT_LT(error_with, 0.5 * error_without);
}

}  // namespace plumbline::testing
