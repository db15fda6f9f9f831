// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/choice_trials.h"

#include "lab/rivals/choose_features.h"
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/pose_information.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>
#include <vector>

namespace plumbline {
namespace {

constexpr int kMostToTryAll = 12;

struct Task {
  CuttingProblem problem;
  std::vector<PointRows> points;
  std::size_t budget = 0;

  double Value(const ChosenFeatures& choice) const {
    CuttingProblem with_points = problem;
    with_points.other_information += SumPoints(points, choice.points);
    return LogDeterminantOf(with_points, choice.lines, CuttingInformation::kIndependent);
  }

  ChosenFeatures Choose(CuttingMethod method) const {
    return ChooseFeatures(problem, points, budget, {method});
  }

  // The marked features, points first, with their lines cut.
  ChosenFeatures Cut(const std::vector<bool>& marked) const {
    ChosenFeatures choice{std::vector<bool>(points.size()),
                          std::vector<LineCut>(problem.lines.size())};
    std::copy_n(marked.begin(), points.size(), choice.points.begin());
    for (std::size_t i = 0; i < problem.lines.size(); ++i) {
      choice.lines[i].used = marked[points.size() + i];
    }
    CutChosen(problem, points, {CuttingMethod::kGreedySweeps}, choice);
    return choice;
  }
};

Task MakeTask(const ChoiceOptions& options, std::uint64_t index) {
  Task task{MakeCuttingScene({SceneKind::kStereo, 0.05, options.lines}, index).problem,
            {},
            static_cast<std::size_t>(options.budget)};
  Rng rng(index, "points to choose from");
  for (int i = 0; i < options.points; ++i) {
    const double depth = rng.Uniform(2, 7);
    const Eigen::Vector3d place =
        depth * Eigen::Vector3d(rng.Uniform(-0.7, 0.7), rng.Uniform(-0.5, 0.5), 1);
    const PointMeasurement seen{task.problem.camera.Project(place), rng.Uniform(1, 3), {}};
    const auto residual = EvaluatePoint(task.problem.camera, Rigid3{}, place, seen);
    task.points.emplace_back(residual->J_pose.topRows<2>());
  }
  return task;
}

std::vector<bool> MarksOf(const ChosenFeatures& choice) {
  std::vector<bool> marks = choice.points;
  for (const LineCut& line : choice.lines) marks.push_back(line.used);
  return marks;
}

ChosenFeatures ChooseApart(const Task& task) {
  Task half = task;
  half.budget /= 2;
  CuttingProblem no_lines = task.problem;
  no_lines.lines.clear();
  ChosenFeatures choice = ChooseFeatures(task.problem, {}, half.budget, {CuttingMethod::kGreedy});
  choice.points = ChooseFeatures(no_lines, task.points, half.budget, {}).points;
  return choice;
}

ChosenFeatures ChooseAtRandom(const Task& task, std::uint64_t index) {
  std::vector<std::size_t> order(task.points.size() + task.problem.lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Rng rng(index, "random choice");
  std::vector<bool> marks(order.size(), false);
  for (std::size_t i = 0; i < task.budget; ++i) {
    std::swap(order[i], order[i + rng.Index(order.size() - i)]);
    marks[order[i]] = true;
  }
  return task.Cut(marks);
}

ChosenFeatures ChooseBy(ChoiceVariant variant, const Task& task, std::uint64_t index) {
  switch (variant) {
    case ChoiceVariant::kTogether:
      return task.Choose(CuttingMethod::kGreedy);
    case ChoiceVariant::kTogetherSweeps:
      return task.Choose(CuttingMethod::kGreedySweeps);
    case ChoiceVariant::kChooseThenCut:
      return task.Cut(MarksOf(task.Choose(CuttingMethod::kNone)));
    case ChoiceVariant::kApart:
      return ChooseApart(task);
    case ChoiceVariant::kWhole:
      return task.Choose(CuttingMethod::kNone);
    case ChoiceVariant::kRandom:
      return ChooseAtRandom(task, index);
  }
  throw BugError("no such choice");
}

double BestOfAllSubsets(const Task& task) {
  const std::size_t size = task.points.size() + task.problem.lines.size();
  double best = -std::numeric_limits<double>::infinity();
  for (unsigned subset = 0; subset < 1U << size; ++subset) {
    if (static_cast<std::size_t>(std::popcount(subset)) != task.budget) continue;
    std::vector<bool> marks(size);
    for (std::size_t i = 0; i < size; ++i) marks[i] = (subset >> i & 1U) != 0;
    best = std::max(best, task.Value(task.Cut(marks)));
  }
  return best;
}

}  // namespace

ChoiceTrial TryChoices(const ChoiceOptions& options, std::uint64_t index) {
  PLUMBLINE_CHECK(options.budget <= options.points + options.lines && options.budget % 2 == 0,
                  "an even budget, not above what there is");
  PLUMBLINE_CHECK(!options.try_all || options.points + options.lines <= kMostToTryAll,
                  "too many features to try all subsets");
  const Task task = MakeTask(options, index);
  ChoiceTrial trial;
  for (const auto& [variant, name] : EnumNames(std::type_identity<ChoiceVariant>{})) {
    const double value = task.Value(ChooseBy(variant, task, index));
    trial.log_determinant[variant] = value;
    trial.best = std::max(trial.best, value);
  }
  if (options.try_all) trial.best = std::max(trial.best, BestOfAllSubsets(task));
  return trial;
}

}  // namespace plumbline
