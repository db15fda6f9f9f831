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

// Which metrics: those that same bytes give again, or times and the like.
enum class MetricKind { kRepeatable, kTiming };

// The metrics of an experiment of one kind, in its order, those of plots alone at the end. An ATE
// is followed by the coverage, always: one without the other says little.
std::vector<const Metric*> MetricsOf(const Experiment& experiment, MetricKind kind);

// A figure of a run, or why there is none.
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
// "unit"}; where value is null, "reason". Behind the figures of runs stand those of `over_runs`.
std::string FormatResults(const std::string& experiment,
                          const std::vector<ResultRow>& rows,
                          const std::vector<FigureRow>& over_runs = {});

}  // namespace plumbline
