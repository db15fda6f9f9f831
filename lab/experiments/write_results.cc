// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/write_results.h"

#include "lab/experiments/dot_plot.h"
#include "lab/experiments/paper_comparison.h"
#include "lab/experiments/paper_plots.h"
#include "lab/experiments/start_plots.h"
#include "lab/experiments/start_pools.h"
#include "lab/experiments/table.h"
#include "lab/experiments/table_list.h"
#include "lab/experiments/table_page.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <system_error>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

void RemovePlots(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".svg") old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path, error);
}

std::vector<PagePlot> MakePlots(const Plan& plan, const std::vector<ResultTable>& tables) {
  std::vector<PagePlot> plots;
  if (!plan.experiment.abscissa.empty()) return plots;  // they are over that
  for (const std::string& name : plan.experiment.plots) {
    for (const ResultTable& table : tables) {
      const auto column = std::find_if(
          table.columns.begin(), table.columns.end(), [&](auto* m) { return m->name == name; });
      if (column == table.columns.end()) continue;
      const auto index = static_cast<std::size_t>(column - table.columns.begin());
      plots.push_back({name, ToSvg(DotPlot(plan, table, index))});
    }
  }
  return plots;
}

void WriteTables(const Plan& plan,
                 const std::vector<JobResult>& results,
                 const Comparisons& compared,
                 const std::vector<PagePlot>& more_plots) {
  MakeFolder(plan.out / "plots");
  RemovePlots(plan.out / "plots");
  std::vector<ResultTable> tables;
  PaperComparison comparison;
  for (const MetricKind kind : {MetricKind::kRepeatable, MetricKind::kTiming}) {
    const bool timing = kind == MetricKind::kTiming;
    tables.push_back(MakeTable(plan, results, kind));
    if (!timing) comparison = CompareWithPaper(plan, tables.back());
    WriteFileAtomically(
        plan.out / (timing ? "timing.json" : "results.json"),
        FormatResults(plan.experiment.name,
                      CollectResults(plan, results, kind),
                      timing ? std::vector<FigureRow>{} : FiguresOfPairs(plan, compared.starts)));
    if (timing && tables.back().columns.empty()) {
      tables.pop_back();
      for (const char* name : {"timing.md", "timing_table.json"}) {
        std::filesystem::remove(plan.out / name);  // of an experiment that measured times
      }
      continue;
    }
    WriteFileAtomically(
        plan.out / (timing ? "timing_table.json" : "table.json"),
        FormatTableList(plan, tables.back(), timing ? PaperComparison{} : comparison));
    WriteFileAtomically(
        plan.out / (timing ? "timing.md" : "table.md"),
        FormatMarkdown(plan, tables.back()) +
            (timing ? ""
                    : FormatPairs(plan, compared.starts) + FormatRatios(plan, compared.ratios) +
                          FormatComparisonMarkdown(comparison)));
  }
  if (!compared.ratios.empty()) {
    WriteFileAtomically(plan.out / "ratios.json", FormatRatioList(plan, compared.ratios));
  }
  std::vector<PagePlot> plots = MakePlots(plan, tables);
  plots.insert(plots.end(), more_plots.begin(), more_plots.end());
  const std::vector<PagePlot> of_paper = PaperPlots(plan, results);
  plots.insert(plots.end(), of_paper.begin(), of_paper.end());
  for (const PagePlot& plot : plots) {
    WriteFileAtomically(plan.out / "plots" / (plot.metric + ".svg"), plot.svg);
  }
  WriteFileAtomically(plan.out / "table.html",
                      FormatPage(plan, tables, plots, compared, comparison));
}

}  // namespace

void WriteResults(const Plan& plan, const std::vector<JobResult>& results) {
  if (plan.experiment.command == RunCommandKind::kComputed) return;
  if (plan.experiment.command != RunCommandKind::kStarts) {
    WriteTables(plan, results, {PairedRatios(plan, results)}, {});
    return;
  }
  const StartsByJob starts = ReadStartsByJob(plan, results);
  const PooledResults pooled = WithPools(plan, results, starts);
  // Pools are rows of tables and no sequences: comparisons are those of the plan without them.
  const Comparisons compared{PairedRatios(plan, results, starts), PairStarts(plan, starts)};
  WriteTables(pooled.plan, pooled.results, compared, StartPlots(plan, starts));
  WriteFileAtomically(plan.out / "starts.csv", FormatStartsByJob(plan, starts));
}

}  // namespace plumbline
