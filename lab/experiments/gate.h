// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/printed_figures.h"

#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Limit of a figure of an experiment.
struct GateLimit {
  std::string experiment, sequence, variant, metric, unit;
  std::optional<double> at_most, at_least;  // one of them
  bool of_mean = false;                     // true: of the mean of all runs; false: of the worst
};

// Throws InputError "name:line: ..." for text that is not of this form, for an unknown experiment,
// variant or metric, and for a unit other than the metric's.
std::vector<GateLimit> ParseGateLimits(const EmbeddedYaml& file);

// Returns the limits of an experiment in gate_limits.yaml; none for most.
std::vector<GateLimit> GateLimitsOf(const std::string& experiment);

struct GateCheck {
  GateLimit limit;
  std::optional<double> figure;  // the worst of the runs, or their mean
  std::string reason;            // reason without a figure
  bool kept = false;
};

// Returns every limit of a sequence and a variant of the plan, with the figure of its runs. A run
// without one exceeds the limit. Limits of missing sequences are left out.
std::vector<GateCheck> CheckGate(const std::vector<GateLimit>& limits,
                                 const Plan& plan,
                                 const std::vector<JobResult>& results);

// A section of a Markdown document: every limit with the figure, exceeded ones first.
std::string FormatGate(const std::vector<GateCheck>& checks);

}  // namespace plumbline
