// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"
#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"

#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Kind of metrics: reproducible ones, or times and the like.
enum class MetricKind { kRepeatable, kTiming };

// Returns the metrics of an experiment of one kind, in its order, those only of plots at the end.
// An ATE is always followed by the coverage, without which it means little.
std::vector<const Metric*> MetricsOf(const Experiment& experiment, MetricKind kind);

// A figure of a run, or the reason why there is none.
struct ResultRow {
  std::string sequence, variant;
  int seed = 0;
  const Metric* metric = nullptr;
  std::optional<double> value;
  std::string reason;  // empty with a value
};

// All figures of one kind, by job, then metric.
std::vector<ResultRow> CollectResults(const Plan& plan,
                                      const std::vector<JobResult>& results,
                                      MetricKind kind);

// A JSON list, one figure a line: {"experiment", "sequence", "variant", "seed", "metric", "value",
// "unit"}; if value is null, "reason". The figures of runs are followed by those of `over_runs`.
std::string FormatResults(const std::string& experiment,
                          const std::vector<ResultRow>& rows,
                          const std::vector<FigureRow>& over_runs = {});

}  // namespace plumbline
