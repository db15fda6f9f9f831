// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/computed.h"

#include "lab/cutting_testbed/testbed.h"
#include "lab/experiments/cutting_testbed_figures.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <array>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

bool RunCuttingTestbed(const ComputedExperiment& self,
                       int repeats,
                       const fs::path& out,
                       const ComputedExperiment::Progress& progress) {
  MakeFolder(out / "plots");  // before minutes of work, so that a bad place is told at once
  bool stopped = false;
  const TestbedTrials trials = RunTestbed(repeats, [&](std::size_t done, std::size_t total) {
    stopped = !progress(done, total);
    return !stopped;
  });
  if (stopped) return false;
  const auto figures = CuttingTestbedFigures(trials);
  const auto plots = CuttingTestbedPlots(trials);
  WriteFileAtomically(out / "results.json", FormatFigureList(self.name, figures));
  WriteFileAtomically(out / "timing.json",
                      FormatFigureList(self.name, CuttingTestbedTimes(trials)));
  WriteFileAtomically(out / "table.md",
                      FormatFigureMarkdown(self.name, self.help, figures, self.metrics));
  WriteFileAtomically(out / "table.html",
                      FormatFigurePage(self.name, self.help, figures, self.metrics, plots));
  for (const PagePlot& plot : plots) {
    WriteFileAtomically(out / "plots" / (plot.metric + ".svg"), plot.svg);
  }
  return true;
}

}  // namespace

std::span<const ComputedExperiment> ComputedExperiments() {
  static const std::array<ComputedExperiment, 1> kExperiments = {
      {{"cutting-testbed",
        "line cutting on simulated lines: ascent against brute force, greedy against joint "
        "optimizers, errors of poses",
        100,
        CuttingTestbedMetrics(),
        RunCuttingTestbed}}};
  return kExperiments;
}

const ComputedExperiment* FindComputedExperiment(std::string_view name) {
  const auto all = ComputedExperiments();
  const auto found = std::find_if(all.begin(), all.end(), [&](auto& e) { return e.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace plumbline
