// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"
#include "lab/starts/start_record.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// The starts of each job of a plan (RunCommandKind::kStarts), in its order; none if it failed.
using StartsByJob = std::vector<std::vector<StartRecord>>;

// Reads starts.csv of the jobs with figures. Throws InputError if one cannot be read.
StartsByJob ReadStartsByJob(const Plan& plan, const std::vector<JobResult>& results);

// The starts of two variants at the same first frames of one run.
std::vector<std::pair<const StartRecord*, const StartRecord*>> CommonStarts(
    const std::vector<StartRecord>& a, const std::vector<StartRecord>& b);

// The starts of one variant on the sequences of a pool, all runs.
std::vector<StartRecord> StartsOfPool(const Plan& plan,
                                      const StartsByJob& starts,
                                      const SequencePool& pool,
                                      std::size_t variant);

struct PooledResults {
  Plan plan;
  std::vector<JobResult> results;
};
// Returns the plan and results with each pool appended as if it were a sequence of its own, with
// the figures of all its starts together. Pools without a sequence in the plan are left out; a run
// of a pool failed if one of its sequences' did.
PooledResults WithPools(const Plan& plan,
                        const std::vector<JobResult>& results,
                        const StartsByJob& starts);

// All starts as one CSV: the columns sequence, variant and seed, then those of FormatStarts.
std::string FormatStartsByJob(const Plan& plan, const StartsByJob& starts);

}  // namespace plumbline
