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

// The starts of each job of a plan (RunCommandKind::kStarts), in its order; none where it failed.
using StartsByJob = std::vector<std::vector<StartRecord>>;

// Reads starts.csv of the jobs that have figures. Throws InputError when one cannot be read.
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
// The same plan and results, and behind them each pool as if it were a sequence of its own, with
// the figures of all its starts together. Pools without a sequence in the plan are left out; where
// a run of one of its sequences failed, that of the pool failed too.
PooledResults WithPools(const Plan& plan,
                        const std::vector<JobResult>& results,
                        const StartsByJob& starts);

// All starts as one CSV: the columns sequence, variant and seed, then those of FormatStarts.
std::string FormatStartsByJob(const Plan& plan, const StartsByJob& starts);

}  // namespace plumbline
