// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/cutting_timing.h"

#include "lab/cutting_testbed/joint_optimizers.h"
#include "lab/cutting_testbed/scene.h"
#include "lab/rivals/cutting_methods.h"
#include "plumbline/base/options.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::array kMetrics = {
    FigureMetric{"mean_gain", "", "rise of log det over full length, mean", 4},
    FigureMetric{"cut_time", "ms", "to cut all lines of a frame, by the clock, median", 3},
};
constexpr std::array kMethods = {
    CuttingMethod::kGreedy, CuttingMethod::kGreedySweeps, CuttingMethod::kJoint};

struct Trials {
  double gain = 0;
  std::vector<double> milliseconds;
};

Trials TryMethod(CuttingMethod method, int lines, int repeats) {
  constexpr double kNoise = 0.05;
  Trials trials;
  for (int i = 0; i < repeats; ++i) {
    const CuttingScene scene =
        MakeCuttingScene({SceneKind::kStereo, kNoise, lines}, static_cast<std::uint64_t>(i));
    const JointObjective objective(scene.problem, CuttingInformation::kIndependent);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<LineCut> cuts = CutLinesBy({method}, scene.problem);
    const auto end = std::chrono::steady_clock::now();
    trials.milliseconds.push_back(std::chrono::duration<double, std::milli>(end - start).count());
    Eigen::VectorXd gradient(objective.size());
    trials.gain +=
        objective(RatiosOf(cuts), gradient) - objective(objective.FullLength(), gradient);
  }
  trials.gain /= repeats;
  return trials;
}

}  // namespace

std::span<const FigureMetric> CuttingTimingMetrics() { return kMetrics; }

std::optional<TimedFigures> TimeCutting(
    int repeats, const std::function<bool(std::size_t, std::size_t)>& progress) {
  constexpr std::array kLines = {10, 30, 60, 100};
  TimedFigures out;
  std::size_t done = 0;
  for (const int lines : kLines) {
    const std::string sequence = fmt::format("lines/{}", lines);
    for (const CuttingMethod method : kMethods) {
      Trials trials = TryMethod(method, lines, repeats);
      auto& times = trials.milliseconds;
      std::sort(times.begin(), times.end());
      out.figures.push_back({sequence, NameOf(method), {}, "mean_gain", trials.gain, ""});
      out.times.push_back(
          {sequence, NameOf(method), {}, "cut_time", times[times.size() / 2], "ms"});
      if (!progress(++done, kLines.size() * kMethods.size())) return std::nullopt;
    }
  }
  return out;
}

}  // namespace plumbline
