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

// What a figure of an experiment must keep.
struct GateLimit {
  std::string experiment, sequence, variant, metric, unit;
  std::optional<double> at_most, at_least;  // one of them
  bool of_mean = false;                     // of all runs, in place of the worst
};

// Throws InputError "name:line: ..." for text that is not of this form, or names an experiment,
// variant or metric that is not there, or another unit than the metric's.
std::vector<GateLimit> ParseGateLimits(const EmbeddedYaml& file);

// The limits of an experiment in gate_limits.yaml; none for most.
std::vector<GateLimit> GateLimitsOf(const std::string& experiment);

struct GateCheck {
  GateLimit limit;
  std::optional<double> figure;  // the worst of the runs, or their mean
  std::string reason;            // why there is none
  bool kept = false;
};

// Every limit that is about a sequence and a variant of the plan, with the figure of its runs. A
// run without one breaks the limit. Limits on sequences that are not there are left out.
std::vector<GateCheck> CheckGate(const std::vector<GateLimit>& limits,
                                 const Plan& plan,
                                 const std::vector<JobResult>& results);

// A section of a Markdown document: every limit with the figure, broken ones first.
std::string FormatGate(const std::vector<GateCheck>& checks);

}  // namespace plumbline
