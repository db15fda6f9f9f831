// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/computed.h"

#include "lab/cutting_testbed/testbed.h"
#include "lab/experiments/cutting_testbed_figures.h"
#include "lab/experiments/cutting_timing.h"
#include "lab/experiments/figure_page.h"
#include "lab/experiments/initialization_timing.h"
#include "lab/experiments/printed_figures.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Results of an experiment.
struct Computed {
  std::vector<FigureRow> figures, times;
  std::vector<PagePlot> plots;
};

void Write(const ComputedExperiment& self, const Computed& computed, const fs::path& out) {
  PaperComparison comparison;
  comparison.statements = PrintedFiguresOf(self.name).statements;
  WriteFileAtomically(out / "results.json", FormatFigureList(self.name, computed.figures));
  WriteFileAtomically(out / "timing.json", FormatFigureList(self.name, computed.times));
  WriteFileAtomically(out / "table.md",
                      FormatFigureMarkdown(self.name, self.help, computed.figures, self.metrics) +
                          FormatComparisonMarkdown(comparison));
  // If times are its subject, the page has them as well.
  std::vector<FigureRow> all = computed.figures;
  if (self.exclusive) {
    all.insert(all.end(), computed.times.begin(), computed.times.end());
    WriteFileAtomically(
        out / "timing.md",
        FormatFigureMarkdown(self.name + ": speed", self.help, computed.times, self.metrics));
  }
  WriteFileAtomically(
      out / "table.html",
      FormatFigurePage(self.name, self.help, all, self.metrics, computed.plots, comparison));
  for (const PagePlot& plot : computed.plots) {
    WriteFileAtomically(out / "plots" / (plot.metric + ".svg"), plot.svg);
  }
}

bool RunCutting(const ComputedExperiment& self,
                TestbedParts parts,
                int repeats,
                const fs::path& out,
                const ComputedExperiment::Progress& progress) {
  MakeFolder(out / "plots");  // before minutes of work, so that a bad place is told at once
  bool stopped = false;
  const TestbedTrials trials = RunTestbed(repeats, parts, [&](std::size_t done, std::size_t total) {
    stopped = !progress(done, total);
    return !stopped;
  });
  if (stopped) return false;
  Write(self,
        {CuttingTestbedFigures(trials), CuttingTestbedTimes(trials), CuttingTestbedPlots(trials)},
        out);
  return true;
}

bool RunCuttingTestbed(const ComputedExperiment& self,
                       int repeats,
                       const fs::path& out,
                       const ComputedExperiment::Progress& progress) {
  return RunCutting(self, TestbedParts::kAll, repeats, out, progress);
}

bool RunCuttingFigures(const ComputedExperiment& self,
                       int repeats,
                       const fs::path& out,
                       const ComputedExperiment::Progress& progress) {
  return RunCutting(self, TestbedParts::kFigures, repeats, out, progress);
}

bool RunCuttingTiming(const ComputedExperiment& self,
                      int repeats,
                      const fs::path& out,
                      const ComputedExperiment::Progress& progress) {
  MakeFolder(out / "plots");
  const auto timing = TimeCutting(repeats, progress);
  if (!timing) return false;
  Write(self, {timing->figures, timing->times, {}}, out);
  return true;
}

bool RunInitializationTiming(const ComputedExperiment& self,
                             int repeats,
                             const fs::path& out,
                             const ComputedExperiment::Progress& progress) {
  MakeFolder(out / "plots");
  const auto timing = TimeInitialization(repeats, progress);
  if (!timing) return false;
  Write(self, {timing->figures, timing->times, {}}, out);
  return true;
}

}  // namespace

std::span<const ComputedExperiment> ComputedExperiments() {
  static const std::vector<ComputedExperiment> kExperiments = {
      {"cutting-testbed",
       "line cutting on simulated lines: ascent against brute force, greedy against joint "
       "optimizers, errors of poses",
       100,
       100,
       4.2,
       false,
       CuttingTestbedMetrics(),
       RunCuttingTestbed},
      {"cutting-figure2-4",
       "Zhao and Vela 2018, figures 2 to 4 on simulated lines: best cuts by the camera's place, "
       "log det by the ratios, gains of optimizers",
       10,
       100,
       3,
       false,
       CuttingTestbedMetrics(),
       RunCuttingFigures},
      {"rippl-timing-initialization",
       "Lee and Hwang 2019, section 5: times of interpolation and factorization on simulated "
       "points",
       50,
       500,
       0.02,
       true,
       InitializationTimingMetrics(),
       RunInitializationTiming},
      {"cutting-timing-optimizers",
       "Zhao and Vela 2018, section 6.2: times of cutting simulated lines",
       50,
       500,
       0.02,
       true,
       CuttingTimingMetrics(),
       RunCuttingTiming}};
  return kExperiments;
}

const ComputedExperiment* FindComputedExperiment(std::string_view name) {
  const auto all = ComputedExperiments();
  const auto found = std::find_if(all.begin(), all.end(), [&](auto& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace plumbline
