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
// Means if failures are tolerated, as in the second paper.
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
  bool best = false;  // true if the best of the variants on this sequence
};

struct TableRow {
  std::size_t sequence = 0, variant = 0;  // in the plan
  int runs = 0;                           // all
  int failed = 0;                         // of these, without a result, or lost (see MakeTable)
  int same = 0;                           // of these, with the trajectory of an earlier run
  double coverage = 0;                    // median over the counted runs, percent; 0 without any
  std::vector<TableCell> cells;           // one for each column
};

// Reason of failed runs, or of failed tries of runs that succeeded later.
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
// Runs with the same trajectory count once, except in times, which differ. Best is the least (or
// greatest) median as printed. Only variants compete with as many values as any other on this
// sequence and at most one percent less coverage: a small error may be due to a skipped difficult
// part. If all are equal, none is best. With Experiment::tolerated_failures means, and no values of
// variants that fail more often.
ResultTable MakeTable(const Plan& plan, const std::vector<JobResult>& results, MetricKind kind);

// Returns "4.21 (4.05-4.33)"; "4.21 (4.05-4.33), 2 without" if runs have a result, but not this
// figure; "-" if none has it.
std::string CellText(const TableRow& row, const TableCell& cell, const Metric& metric);
// Returns the numbers of counted, equal and failed runs: "5", "1, 4 the same", "3, 2 failed".
std::string RunsText(const TableRow& row);
// Returns "ate [mm]".
std::string ColumnTitle(const Metric& metric);

// Returns a document with the table, best cells bold, and all failed or missing runs.
std::string FormatMarkdown(const Plan& plan, const ResultTable& table);

// Returns one sentence for each failure and each failed try: "failed: euroc/a, points, 2 runs:
// why".
std::vector<std::string> FailureTexts(const Plan& plan, const ResultTable& table);

}  // namespace plumbline
