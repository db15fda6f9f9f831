// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/joint_trials.h"

#include "plumbline/base/random.h"
#include "plumbline/line_cutting/ratio_ascent.h"

#include <algorithm>
#include <chrono>

namespace plumbline {
namespace {

constexpr int kRandomStarts = 8;

double BestFrom(const JointObjective& objective, const Eigen::VectorXd& start) {
  return Ascend<Eigen::Dynamic>(objective, start, {.max_iterations = 500}).value;
}

}  // namespace

JointTrial TryJointly(const CuttingScene& scene,
                      CuttingInformation information,
                      std::uint64_t index) {
  using Clock = std::chrono::steady_clock;
  const JointObjective objective(scene.problem, information);
  JointTrial trial;
  Eigen::VectorXd gradient;
  for (const auto& [optimizer, name] : EnumNames(std::type_identity<JointOptimizer>{})) {
    const auto begin = Clock::now();
    const Eigen::VectorXd ratios = OptimizeJointly(scene.problem, information, optimizer);
    const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
    trial.outcomes[optimizer] = {objective(ratios, gradient), time.count()};
    trial.best = std::max(trial.best, trial.outcomes[optimizer].log_determinant);
    if (optimizer == JointOptimizer::kSweeps) {
      trial.best = std::max(trial.best, BestFrom(objective, ratios));
    }
  }
  Rng rng(index, "joint starts");
  for (int i = 0; i < kRandomStarts; ++i) {
    Eigen::VectorXd start(objective.size());
    for (double& ratio : start) ratio = rng.Uniform();
    trial.best = std::max(trial.best, BestFrom(objective, start));
  }
  return trial;
}

}  // namespace plumbline
