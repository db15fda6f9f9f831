// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"

#include <vector>

namespace plumbline {

// Writes results.json, timing.json, table.md, timing.md, table.html and plots/<metric>.svg into the
// folder of the plan; for starts also starts.csv, their plots, and the pools as further rows; for
// the reproduction of a paper its figures and plots. Plots of other metrics are removed. A computed
// experiment wrote its files itself. Throws InputError if a file cannot be written.
void WriteResults(const Plan& plan, const std::vector<JobResult>& results);

}  // namespace plumbline
