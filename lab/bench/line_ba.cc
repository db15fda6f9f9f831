// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Local bundle adjustment by the parameters of its lines: time, iterations, cost and memory on the
// same problems with the same solver. Prints a Markdown table; writes CSV for
// tools/plot_line_ba.py.
//
//   line_ba OUT.csv [REPETITIONS] [MOST_LINES] [SHARE_OF_OUTLIERS]
//
// Meaning of the numbers, and results: docs/benchmarks.md.
#include "lab/line_rivals/rival_ba.h"

#include "tests/optimization/ba_scene.h"
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

struct Rival {
  const char* name;
  RivalLines lines;
  double correlation;  // of the two residuals; 0 lets the blocks of end points split
};
// The covariance has a small correlation if the blocks must not split.
constexpr double kWhole = 1e-6;
constexpr std::array kRivals{
    Rival{"plucker", {LineParametrization::kPlucker, LineResidualKind::kObservedEnds}, 0},
    Rival{"plucker_left", {LineParametrization::kPluckerLeft, LineResidualKind::kObservedEnds}, 0},
    Rival{"endpoints", {LineParametrization::kEndpoints, LineResidualKind::kObservedEnds}, 0},
    Rival{
        "plucker, projected", {LineParametrization::kPlucker, LineResidualKind::kProjectedEnds}, 0},
    Rival{"endpoints, projected",
          {LineParametrization::kEndpoints, LineResidualKind::kProjectedEnds},
          kWhole},
    Rival{"endpoints, projected, split",
          {LineParametrization::kEndpoints, LineResidualKind::kProjectedEnds},
          0}};

double CpuMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

BaProblem MakeProblem(int points, int lines, double outliers, const Rival& rival) {
  BaProblem problem = testing::MakeBaScene(1,
                                           {.poses = 15,
                                            .free_poses = 10,
                                            .points = points,
                                            .lines = lines,
                                            .sigma = 1,
                                            .outliers = outliers,
                                            .perturbation = 0.3})
                          .problem;
  for (auto& o : problem.line_observations) {
    o.measurement.covariance(0, 1) = o.measurement.covariance(1, 0) = rival.correlation;
  }
  return problem;
}

struct Figures {
  std::vector<double> milliseconds;
  int iterations = 0;
  double cost = 0;
  std::size_t line_bytes = 0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// All rivals in turn, so that a busy machine is busy for all of them.
std::vector<Figures> Measure(int points, int lines, double outliers, int repetitions) {
  // One round to convergence: 1e-4 of the cost, as local mapping has it.
  const LocalBaOptions options{.rounds = 1, .max_iterations = 60};
  std::vector<BaProblem> problems;
  for (const Rival& rival : kRivals)
    problems.push_back(MakeProblem(points, lines, outliers, rival));
  std::vector<Figures> figures(kRivals.size());
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < kRivals.size(); ++i) {
      const double start = CpuMilliseconds();
      const BaResult result = SolveRivalBa(problems[i], options, kRivals[i].lines);
      figures[i].milliseconds.push_back(CpuMilliseconds() - start);
      figures[i].iterations = result.iterations;
      figures[i].cost = result.final_cost;
      figures[i].line_bytes = result.line_bytes;
    }
  }
  return figures;
}

void Print(int points, int lines, const std::vector<Figures>& all) {
  const auto least = [](const Figures& f) {
    return *std::min_element(f.milliseconds.begin(), f.milliseconds.end());
  };
  for (std::size_t i = 0; i < kRivals.size(); ++i) {
    const Figures& f = all[i];
    fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {} | {:.3f} | {:.2f} | {:.2f} | {:.1f} | {} |\n",
               points,
               lines,
               kRivals[i].name,
               least(f),
               Median(f.milliseconds),
               f.iterations,
               least(f) / f.iterations,
               least(f) / least(all[0]),
               least(f) / f.iterations / (least(all[0]) / all[0].iterations),
               f.cost,
               f.line_bytes / static_cast<std::size_t>(lines));
  }
  std::fflush(stdout);
}

int Main(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.size() > 4) {
    fmt::print(stderr, "usage: line_ba OUT.csv [REPETITIONS] [MOST_LINES] [SHARE_OF_OUTLIERS]\n");
    return 2;
  }
  const int repetitions = arguments.size() > 1 ? std::stoi(arguments[1]) : 9;
  const int most_lines = arguments.size() > 2 ? std::stoi(arguments[2]) : 5000;
  const double outliers = arguments.size() > 3 ? std::stod(arguments[3]) : 0.03;
  std::ofstream csv(arguments[0]);
  csv << "points,lines,rival,min_ms,median_ms,iterations,cost\n";
  fmt::print(
      "| points | lines | rival | min ms | median ms | iterations | ms each | time / plucker | "
      "each / plucker | cost | bytes a line |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int points : {0, 2000}) {
    for (const int lines : {100, 300, 1000, 3000, 5000}) {
      if (lines > most_lines) continue;
      const auto figures =
          Measure(points, lines, outliers, lines > 1000 ? (repetitions + 1) / 2 : repetitions);
      Print(points, lines, figures);
      for (std::size_t i = 0; i < kRivals.size(); ++i) {
        const Figures& f = figures[i];
        csv << fmt::format("{},{},\"{}\",{:.4f},{:.4f},{},{:.3f}\n",
                           points,
                           lines,
                           kRivals[i].name,
                           *std::min_element(f.milliseconds.begin(), f.milliseconds.end()),
                           Median(f.milliseconds),
                           f.iterations,
                           f.cost);
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) { return plumbline::Main({argv + 1, argv + argc}); }
