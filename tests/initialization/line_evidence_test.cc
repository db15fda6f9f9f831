// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/line_evidence.h"

#include "tests/initialization/window_scene.h"
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeWindowScene;
using testing::RotationErrorDeg;
using testing::WindowScene;
using testing::WindowSceneOptions;

constexpr double kSigma = 5e-4;
constexpr int kSeeds = 20;

Explanation ByPoints(const WindowScene& scene) {
  Explanation explanation;
  explanation.solution = scene.truth;
  explanation.solution.lines.clear();
  AdjustExplanation(scene.tracks, explanation);
  return explanation;
}

TEST(ExplainWithLines, MakesFewPointsAccurate) {
  double points = 0;
  double lines = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    WindowScene scene = MakeWindowScene(
        seed, CurvedMotion(3), {.points = 14, .sigma = kSigma, .lines = 40, .line_noise = 0.25});
    const Explanation by_points = ByPoints(scene);
    const auto explained = ExplainWithLines(scene.tracks, {by_points}, 0.25);
    const Rigid3& truth = scene.truth.cam_from_reference.back();
    const auto squared = [&](const WindowSolution& solution) {
      return std::pow(RotationErrorDeg(solution.cam_from_reference.back(), truth), 2);
    };
    points += squared(by_points.solution);
    lines += squared(explained.front().solution);
  }
  EXPECT_LT(std::sqrt(lines), 0.7 * std::sqrt(points));
}

// They fit no explanation, and so count for none.
TEST(ExplainWithLines, LeavesWrongMatchesOut) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    WindowScene scene = MakeWindowScene(
        seed, CurvedMotion(3), {.points = 30, .sigma = kSigma, .lines = 30, .wrong_lines = 6});
    const auto explained = ExplainWithLines(scene.tracks, {ByPoints(scene)}, 0.25);
    const Explanation& best = explained.front();
    EXPECT_LE(best.lines, 25);  // one by chance
    EXPECT_GE(best.lines, 20);
    const Rigid3& truth = scene.truth.cam_from_reference.back();
    EXPECT_LT(RotationErrorDeg(best.solution.cam_from_reference.back(), truth), 0.35) << seed;
    EXPECT_LT(DirectionErrorDeg(best.solution.cam_from_reference.back(), truth), 2) << seed;
    // Of the 24, up to some in an epipolar plane: what four degrees of freedom each leave over.
    EXPECT_LT(best.cost - best.fit.cost, 24 * 8);
  }
}

// Of what the lines are said to have: half.
TEST(ExplainWithLines, FindsTheNoiseOfTheLines) {
  WindowScene scene =
      MakeWindowScene(5, CurvedMotion(3), {.points = 60, .sigma = kSigma, .lines = 200});
  for (TrackedLines* view : {&scene.tracks.lines.reference,
                             &scene.tracks.lines.views[0],
                             &scene.tracks.lines.views[1],
                             &scene.tracks.lines.views[2]}) {
    for (double& sigma : view->sigmas) sigma *= 2;
  }
  const auto explained = ExplainWithLines(scene.tracks, {ByPoints(scene)}, 0.05);
  EXPECT_NEAR(
      explained.front().line_noise * scene.tracks.lines.reference.sigmas[0] / kSigma, 1, 0.15);
}

// On a plane, by a camera that hardly turns, the valley has a second minimum.
TEST(ExplainWithLines, FindsAnotherMinimumOfTheValley) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    WindowScene scene = MakeWindowScene(
        seed, CurvedMotion(3, 0.15), {.points = 14, .plane = true, .sigma = kSigma, .lines = 15});
    const auto explained = ExplainWithLines(scene.tracks, {ByPoints(scene)}, 0.25);
    for (std::size_t j = 1; j < explained.size(); ++j) {
      EXPECT_LE(explained[j - 1].cost, explained[j].cost);
      EXPECT_FALSE(IsSame(explained[0].solution, explained[j].solution));
    }
    found += explained.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace plumbline
