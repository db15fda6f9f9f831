// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// The errors of one variant divided by those of the reference variant, run by run.
struct PairedRatio {
  std::optional<std::size_t>
      sequence;  // in the plan; nullopt: all sequences, each with equal weight
  std::size_t variant = 0;
  int pairs = 0;     // runs that count
  int left_out = 0;  // runs without both errors, or whose coverages differ by more than one percent
  double ratio = 1;  // geometric mean
  double low = 1, high = 1;  // 95 % of the bootstrap samples lie between
  // Runs in which this variant lost frames or failed while another variant did not.
  int lost_alone = 0;
  std::string metric = "ate";  // of metrics.h
};

// The errors that plan.experiment.ratios names, of each variant against plan.experiment.reference:
// one metric after the other, by sequence and over all. Empty without a reference, or where the
// plan leaves it out.
//
// Paired: the same run of the same sequence. Pairs whose two trajectories have both been seen
// before count once. The intervals come from 2000 bootstrap samples: of the pairs of a sequence;
// over all, of the sequences first, then of the pairs of each. One pair, or one sequence, has no
// spread of its own: the interval then says less than it seems to.
std::vector<PairedRatio> PairedRatios(const Plan& plan, const std::vector<JobResult>& results);

// "0.97 (0.93-1.02)"; "-" without a pair.
std::string RatioText(const PairedRatio& ratio);

// The ratios of one metric after the other, as they come.
std::vector<std::vector<PairedRatio>> ByMetric(const std::vector<PairedRatio>& ratios);

// "ATE against plucker": the heading of the ratios of a metric.
std::string RatioTitle(const Plan& plan, const std::string& metric);

// A JSON list of {"metric", "variant", "sequence" (null: all), "pairs", "left_out", "lost_alone",
// "ratio", "low", "high"}; the last three are null without a pair.
std::string FormatRatioList(const Plan& plan, const std::vector<PairedRatio>& ratios);

// A section of a Markdown document for each metric; empty for no ratios.
std::string FormatRatios(const Plan& plan, const std::vector<PairedRatio>& ratios);

}  // namespace plumbline
