// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/multi_view.h"

#include "tests/initialization/window_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace multi_view_test {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeWindowScene;
using testing::RotationErrorDeg;
using testing::WindowScene;
using testing::WindowSceneOptions;

constexpr double kSigma = 0.25 / 520;  // of the corners of recorded images, in the median
constexpr int kSeeds = 20;

// Twice, since the first time there is nothing to confirm it.
WindowDecision Decide(const WindowScene& scene, std::uint64_t seed) {
  WindowMemory memory;
  Rng rng(seed, "decide");
  EXPECT_FALSE(DecideWindow(scene.tracks, {}, memory, rng).solution);
  return DecideWindow(scene.tracks, {}, memory, rng);
}

bool IsRight(const WindowScene& scene, const WindowSolution& solution) {
  const Rigid3& truth = scene.truth.cam_from_reference.back();
  const Rigid3& found = solution.cam_from_reference.back();
  return RotationErrorDeg(found, truth) < 0.5 && DirectionErrorDeg(found, truth) < 5;
}

struct Count {
  int right = 0, wrong = 0;
};

Count CountOf(const std::vector<Rigid3>& poses, const WindowSceneOptions& options) {
  Count count;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const WindowScene scene = MakeWindowScene(seed, poses, options);
    const WindowDecision decision = Decide(scene, seed);
    EXPECT_EQ(decision.solution.has_value(), decision.wait == InitializationWait::kNone);
    if (!decision.solution) continue;
    ++(IsRight(scene, *decision.solution) ? count.right : count.wrong);
  }
  return count;
}

TEST(DecideWindow, FindsACloudOfPoints) {
  const Count count =
      CountOf(CurvedMotion(3, 1), {.sigma = kSigma, .missed = 0.2, .outliers = 0.06});
  EXPECT_GE(count.right, kSeeds - 1);
  EXPECT_EQ(count.wrong, 0);
}

// The twofold ambiguity of a plane is decided by motion that changes its direction.
TEST(DecideWindow, TellsTheTwoInterpretationsOfAPlaneApart) {
  const Count count = CountOf(CurvedMotion(4, 1.4), {.plane = true, .sigma = kSigma});
  EXPECT_GE(count.right, kSeeds - 3);
  EXPECT_EQ(count.wrong, 0);
}

// Straight on, without turning, all frames share both interpretations: nothing to decide by.
TEST(DecideWindow, WaitsWhereAPlaneIsAmbiguous) {
  std::vector<Rigid3> poses;
  for (int i = 1; i <= 3; ++i) {
    poses.push_back({Eigen::Quaterniond::Identity(), -0.15 * i * Eigen::Vector3d(1, 0.2, 0.2)});
  }
  const Count count = CountOf(poses, {.plane = true, .sigma = kSigma});
  EXPECT_EQ(count.wrong, 0);
}

TEST(DecideWindow, WaitsWhileTheCameraTurnsOrStands) {
  std::vector<Rigid3> turning;
  for (int i = 1; i <= 3; ++i) turning.push_back({ExpSo3({0, 0.05 * i, 0.01 * i}), {0, 0, 0}});
  const std::vector<Rigid3> standing(3);
  for (const auto& poses : {turning, standing}) {
    const Count count = CountOf(poses, {.sigma = kSigma, .outliers = 0.05});
    EXPECT_EQ(count.right + count.wrong, 0);
  }
}

// A third of the points move together before a camera that stands: they alone show parallax.
TEST(DecideWindow, WaitsWhenAThingMovesBeforeACameraAtRest) {
  const std::vector<Rigid3> thing = CurvedMotion(3);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    WindowScene scene = MakeWindowScene(seed, std::vector<Rigid3>(3), {.sigma = kSigma});
    for (std::size_t k = 0; k < scene.tracks.size(); k += 3) {
      for (std::size_t i = 0; i < thing.size(); ++i) {
        scene.tracks.views[i].points[k] = (thing[i] * scene.truth.points[k]).hnormalized();
      }
    }
    EXPECT_FALSE(Decide(scene, seed).solution) << seed;
  }
}

TEST(DecideWindow, NeedsMatches) {
  const WindowScene scene = MakeWindowScene(1, CurvedMotion(3), {.points = 20});
  EXPECT_EQ(Decide(scene, 1).wait, InitializationWait::kTooFewMatches);
}

// A wall with a dozen corners and the edges of what hangs there.
TEST(DecideWindow, StartsFromFewPointsAndLines) {
  const WindowSceneOptions few{.points = 16, .sigma = kSigma};
  WindowSceneOptions lines = few;
  lines.lines = 40;
  lines.line_noise = 0.2;  // of lines in rendered images against corners there
  lines.wrong_lines = 4;
  const Count without = CountOf(CurvedMotion(3, 1), few);
  EXPECT_EQ(without.right + without.wrong, 0);
  const Count with = CountOf(CurvedMotion(3, 1), lines);
  EXPECT_GE(with.right, kSeeds / 2);
  EXPECT_EQ(with.wrong, 0);
}

TEST(DecideWindow, WaitsWithLinesWhileTheCameraTurnsOrStands) {
  std::vector<Rigid3> turning;
  for (int i = 1; i <= 3; ++i) turning.push_back({ExpSo3({0, 0.05 * i, 0.01 * i}), {0, 0, 0}});
  const std::vector<Rigid3> standing(3);
  for (const auto& poses : {turning, standing}) {
    const Count count = CountOf(poses, {.points = 30, .sigma = kSigma, .lines = 40});
    EXPECT_EQ(count.right + count.wrong, 0);
  }
}

TEST(DecideWindow, ScalesTheMedianDepthToOneAndTellsTheParallax) {
  const WindowScene scene = MakeWindowScene(2, CurvedMotion(3), {.points = 301});
  const WindowDecision decision = Decide(scene, 2);
  ASSERT_TRUE(decision.solution);
  int below = 0;
  for (const Eigen::Vector3d& point : decision.solution->points) below += point.z() < 1 ? 1 : 0;
  EXPECT_EQ(below, 150);
  EXPECT_GT(decision.parallax_deg, 3);
  EXPECT_LT(decision.parallax_deg, 10);
}

TEST(WindowMemory, BringsPointsBackByFeature) {
  const WindowScene scene = MakeWindowScene(3, CurvedMotion(2), {.points = 50});
  WindowMemory memory;
  memory.Keep(scene.tracks, {scene.truth}, true);
  EXPECT_TRUE(memory.sure());
  WindowTracks later;
  later.features = {7, 1000, 3};
  const auto hypotheses = memory.HypothesesFor(later);
  ASSERT_EQ(hypotheses.size(), 1U);
  EXPECT_EQ(
      hypotheses[0].inverse_distances,
      (std::vector<double>{1 / scene.truth.points[7].norm(), 0, 1 / scene.truth.points[3].norm()}));
  memory.Clear();
  EXPECT_TRUE(memory.HypothesesFor(later).empty());
}

}  // namespace multi_view_test
}  // namespace plumbline
