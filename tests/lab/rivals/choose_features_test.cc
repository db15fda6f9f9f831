// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/choose_features.h"

#include "plumbline/line_cutting/pose_information.h"

#include "tests/line_cutting/random_points.h"
#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr auto kIndependent = CuttingInformation::kIndependent;

struct Scene {
  CuttingProblem problem;
  std::vector<PointRows> points;

  double Value(const ChosenFeatures& choice) const {
    CuttingProblem with_points = problem;
    with_points.other_information += SumPoints(points, choice.points);
    return LogDeterminantOf(with_points, choice.lines, kIndependent);
  }
};

Scene RandomScene(std::uint64_t seed, int points, int lines) {
  return {RandomProblem(seed, lines), RandomPoints(seed, points)};
}

std::size_t CountUsed(const ChosenFeatures& choice) {
  const auto lines = std::count_if(
      choice.lines.begin(), choice.lines.end(), [](const LineCut& cut) { return cut.used; });
  return static_cast<std::size_t>(lines +
                                  std::count(choice.points.begin(), choice.points.end(), true));
}

ChosenFeatures Nothing(const Scene& scene) {
  ChosenFeatures choice{std::vector<bool>(scene.points.size(), false),
                        std::vector<LineCut>(scene.problem.lines.size())};
  for (LineCut& line : choice.lines) line.used = false;
  return choice;
}

// Looks at every feature, whole, each time.
ChosenFeatures ChooseByLookingAtAll(const Scene& scene, std::size_t budget) {
  ChosenFeatures choice = Nothing(scene);
  while (CountUsed(choice) < budget) {
    ChosenFeatures best;
    double best_value = -std::numeric_limits<double>::infinity();
    const auto look = [&](const ChosenFeatures& with) {
      const double value = scene.Value(with);
      if (value <= best_value) return;
      best_value = value;
      best = with;
    };
    for (std::size_t i = 0; i < choice.points.size() + choice.lines.size(); ++i) {
      ChosenFeatures with = choice;
      if (i < choice.points.size()) {
        if (choice.points[i]) continue;
        with.points[i] = true;
      } else {
        LineCut& line = with.lines[i - choice.points.size()];
        if (line.used) continue;
        line.used = true;
      }
      look(with);
    }
    choice = best;
  }
  return choice;
}

TEST(ChooseFeatures, IsTheChoiceOfLookingAtAll) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Scene scene = RandomScene(seed, 20, 15);
    const ChosenFeatures lazy = ChooseFeatures(scene.problem, scene.points, 12, {});
    const ChosenFeatures all = ChooseByLookingAtAll(scene, 12);
    EXPECT_EQ(lazy.points, all.points);
    for (std::size_t i = 0; i < all.lines.size(); ++i) {
      EXPECT_EQ(lazy.lines[i].used, all.lines[i].used);
    }
  }
}

TEST(ChooseFeatures, IsNearTheBestOfAllSubsets) {
  constexpr std::size_t kBudget = 5;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Scene scene = RandomScene(seed, 5, 5);
    double best = -std::numeric_limits<double>::infinity();
    for (unsigned subset = 0; subset < 1U << 10U; ++subset) {
      if (std::popcount(subset) != kBudget) continue;
      ChosenFeatures choice = Nothing(scene);
      for (std::size_t i = 0; i < 5; ++i) {
        choice.points[i] = (subset >> i & 1U) != 0;
        choice.lines[i].used = (subset >> (5 + i) & 1U) != 0;
      }
      best = std::max(best, scene.Value(choice));
    }
    const double whole = scene.Value(ChooseFeatures(scene.problem, scene.points, kBudget, {}));
    EXPECT_LE(whole, best + 1e-9);
    EXPECT_GT(whole, best - 1);
    const CuttingRecipe cut{CuttingMethod::kGreedySweeps};
    EXPECT_GT(scene.Value(ChooseFeatures(scene.problem, scene.points, kBudget, cut)), whole);
  }
}

TEST(ChooseFeatures, KeepsToTheBudgetWithEveryMethodAndInformation) {
  const Scene scene = RandomScene(3, 15, 15);
  for (const auto& [method, name] : EnumNames(std::type_identity<CuttingMethod>{})) {
    for (const auto& [information, text] : EnumNames(std::type_identity<CuttingInformation>{})) {
      const ChosenFeatures choice =
          ChooseFeatures(scene.problem, scene.points, 12, {method, information});
      EXPECT_EQ(CountUsed(choice), 12U) << name << " " << text;
    }
  }
}

TEST(ChooseFeatures, UsesAllWhereThereIsNotMoreThanTheBudget) {
  const Scene scene = RandomScene(4, 7, 6);
  CuttingProblem with_points = scene.problem;
  with_points.other_information += SumPoints(scene.points);
  const CuttingRecipe greedy{CuttingMethod::kGreedy};
  const ChosenFeatures choice = ChooseFeatures(scene.problem, scene.points, 13, greedy);
  EXPECT_EQ(choice.points, std::vector<bool>(7, true));
  EXPECT_EQ(choice.lines, CutLinesBy(greedy, with_points));
}

TEST(ChooseFeatures, LeavesOutWhatSaysLittle) {
  Scene scene = RandomScene(5, 20, 10);
  for (const std::size_t i : {0U, 3U, 9U}) scene.points[i] *= 1e-3;
  for (const std::size_t i : {2U, 5U}) {
    scene.problem.lines[i].start_covariance *= 1e6;
    scene.problem.lines[i].end_covariance *= 1e6;
  }
  const ChosenFeatures choice = ChooseFeatures(scene.problem, scene.points, 25, {});
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(choice.points[i], i != 0 && i != 3 && i != 9);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(choice.lines[i].used, i != 2 && i != 5);
}

TEST(ChooseFeatures, DroppedLinesAreNotChosen) {
  Scene scene = RandomScene(6, 4, 10);
  scene.problem.lines[4].start_covariance *= 1e4;
  scene.problem.lines[4].end_covariance *= 1e4;
  const CuttingRecipe drop{.method = CuttingMethod::kDrop, .drop_share = 0.1};
  const ChosenFeatures choice = ChooseFeatures(scene.problem, scene.points, 13, drop);
  EXPECT_EQ(CountUsed(choice), 13U);
  EXPECT_FALSE(choice.lines[4].used);
}

TEST(ChooseFeatures, ChoosesNothingFromNothing) {
  const Scene scene = RandomScene(7, 0, 0);
  EXPECT_EQ(CountUsed(ChooseFeatures(scene.problem, scene.points, 5, {})), 0U);
  const Scene some = RandomScene(7, 3, 3);
  EXPECT_EQ(CountUsed(ChooseFeatures(some.problem, some.points, 0, {})), 0U);
}

}  // namespace
}  // namespace plumbline
