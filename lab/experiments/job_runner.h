// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_executor.h"
#include "lab/experiments/metrics.h"
#include "lab/experiments/plan.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Result of a job: figures, or the reason why there are none.
struct JobResult {
  std::optional<RunFigures> figures;
  std::string reason;
  // Reasons of earlier failed tries, in order.
  std::vector<std::string> earlier = {};
};

// Progress of an experiment.
struct RunnerState {
  std::size_t done = 0, total = 0, failed = 0, running = 0;
  std::string current;  // "euroc/MH_01_easy/points/1", or the world being rendered
  double seconds_left = 0;
};

struct RunnerOptions {
  std::filesystem::path program;  // this program
  std::filesystem::path earlier;  // for variants that are by_earlier
  bool force = false;             // run finished jobs again
  // Jobs that take longer are killed. nullopt: a minute, and a second for each frame.
  std::optional<double> time_limit_s = std::nullopt;
  std::optional<int> memory_mb = std::nullopt;  // memory limit of one job
  // Number of retries of a job that crashes, or whose machine fails. Bad input, too little memory
  // and too long a time would be the same again.
  int retries = 0;
  std::function<void(const RunnerState&)> progress = {};  // called often
  std::function<bool()> stop = {};                        // called often; true ends everything
};

// Does the unfinished jobs of plans: renders the worlds they need, then has the executor run the
// program for each. Those of experiments that measure times come last.
//
// A job that crashes, hangs or fails is a result with a reason; the next call tries it again. The
// result of a job counts only after the normal end of its program, so that the next call continues
// after any interruption of this function. The reasons contain no paths.
//
//   folder    common to all plans, or a folder above; no other process may do jobs in it meanwhile
//   finished  called for each plan as soon as all its jobs have a result; may throw
//   returns   a result for each job of each plan; nullopt if told to stop
//   fails     InputError if another process does jobs in the same folder, folders cannot be
//             written, or a world cannot be rendered
using PlanFinished = std::function<void(std::size_t plan, const std::vector<JobResult>&)>;
std::optional<std::vector<std::vector<JobResult>>> RunPlans(const std::vector<const Plan*>& plans,
                                                            const std::filesystem::path& folder,
                                                            JobExecutor& executor,
                                                            const RunnerOptions& options,
                                                            const PlanFinished& finished = {});

// Like RunPlans, for a single plan.
std::optional<std::vector<JobResult>> RunJobs(const Plan& plan,
                                              JobExecutor& executor,
                                              const RunnerOptions& options);

// Returns the estimated time of the jobs without a time, one after the other: for each the mean of
// those of the same sequence and variant, otherwise EstimatedSeconds times the ratio of measured
// and estimated times so far.
double SecondsLeft(const Plan& plan, const std::vector<std::optional<double>>& seconds_of_job);

}  // namespace plumbline
