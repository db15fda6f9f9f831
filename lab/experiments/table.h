// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/results.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

enum class Centre { kMedian, kMean };
// Means where failures are tolerated, as the second paper has it.
Centre CentreOf(const Experiment& experiment);

struct Spread {
  double centre = 0, min = 0, max = 0;
};
// nullopt for no values. The median of an even number is the mean of the middle two.
std::optional<Spread> SpreadOf(std::vector<double> values, Centre centre = Centre::kMedian);

// A metric of one variant on one sequence, over the runs.
struct TableCell {
  std::optional<Spread> spread;
  int missing = 0;    // runs without a value
  bool best = false;  // of the variants on this sequence
};

struct TableRow {
  std::size_t sequence = 0, variant = 0;  // in the plan
  int runs = 0;                           // all
  int failed = 0;                         // of these, without a result, or lost (see MakeTable)
  int same = 0;                           // of these, with the trajectory of an earlier run
  double coverage = 0;                    // median over the runs that count, percent; 0 without any
  std::vector<TableCell> cells;           // one for each column
};

// Why runs failed, or tries of runs that went well in the end.
struct Failure {
  std::size_t sequence = 0, variant = 0;
  int runs = 0;  // or tries
  std::string reason;
};

struct ResultTable {
  MetricKind kind = MetricKind::kRepeatable;
  std::vector<const Metric*> columns;
  std::vector<TableRow> rows;  // by sequence, then variant
  std::vector<Failure> failures;
  std::vector<Failure> tried_again;
};

// Medians and ranges over the runs of each variant on each sequence.
//
// Runs with the same trajectory count once, but in times, which differ. Best is the least (or
// greatest) median as printed. Only those compete that have as many values as any other variant on
// this sequence and cover at most one percent of the frames less: an error is not small because the
// difficult part was left out. Where all are equal, none is best. With
// Experiment::tolerated_failures means, and nothing of variants that fail more often.
ResultTable MakeTable(const Plan& plan, const std::vector<JobResult>& results, MetricKind kind);

// "4.21 (4.05-4.33)"; "4.21 (4.05-4.33), 2 without" where runs have a result, but not this figure;
// "-" where none has it.
std::string CellText(const TableRow& row, const TableCell& cell, const Metric& metric);
// How many runs count, are the same as others, have failed: "5", "1, 4 the same", "3, 2 failed".
std::string RunsText(const TableRow& row);
// "ate [mm]"
std::string ColumnTitle(const Metric& metric);

// A document with the table, best cells bold, and what failed or is missing.
std::string FormatMarkdown(const Plan& plan, const ResultTable& table);

// One sentence for each failure and each try that failed: "failed: euroc/a, points, 2 runs: why".
std::vector<std::string> FailureTexts(const Plan& plan, const ResultTable& table);

}  // namespace plumbline
