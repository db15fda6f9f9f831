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

// What came of a job: figures, or the reason why there are none.
struct JobResult {
  std::optional<RunFigures> figures;
  std::string reason;
  // Why earlier tries failed, in their order.
  std::vector<std::string> earlier = {};
};

// How far an experiment is.
struct RunnerState {
  std::size_t done = 0, total = 0, failed = 0, running = 0;
  std::string current;  // "euroc/MH_01_easy/points/1", or what is rendered
  double seconds_left = 0;
};

struct RunnerOptions {
  std::filesystem::path program;  // ours
  std::filesystem::path earlier;  // of variants that are by_earlier
  bool force = false;             // run again what is done
  // A job that takes longer than this is killed. nullopt: a minute, and a second for each frame.
  std::optional<double> time_limit_s = std::nullopt;
  std::optional<int> memory_mb = std::nullopt;  // what one job may use at most
  // How often a job is tried again that crashes, or whose machine goes away. Bad input, too little
  // memory and too long a time would be the same again.
  int retries = 0;
  std::function<void(const RunnerState&)> progress = {};  // called often
  std::function<bool()> stop = {};                        // asked often; true ends all
};

// Does the jobs of plans that are not done: renders the worlds they need, then has the executor run
// the program for each. Those of experiments that measure times come last.
//
// A job that crashes, hangs or fails is a result with a reason; the next call tries it again. The
// result of a job counts only once its program has ended well, so that whatever ends this function
// in the middle, the next call goes on where it was. The reasons hold no paths.
//
//   folder    that all plans write to, or a folder above; nobody else may do jobs in it meanwhile
//   finished  called for each plan as soon as all its jobs have a result; may throw
//   returns   a result for each job of each plan; nullopt when told to stop
//   fails     InputError when another process does jobs in the same folder, folders cannot be
//             written, or a world cannot be rendered
using PlanFinished = std::function<void(std::size_t plan, const std::vector<JobResult>&)>;
std::optional<std::vector<std::vector<JobResult>>> RunPlans(const std::vector<const Plan*>& plans,
                                                            const std::filesystem::path& folder,
                                                            JobExecutor& executor,
                                                            const RunnerOptions& options,
                                                            const PlanFinished& finished = {});

// Does what RunPlans does, for a single plan.
std::optional<std::vector<JobResult>> RunJobs(const Plan& plan,
                                              JobExecutor& executor,
                                              const RunnerOptions& options);

// Time that the jobs without a time will take, one after the other: for each the mean of those of
// the same sequence and variant, else EstimatedSeconds times what all so far took by what was
// estimated for them.
double SecondsLeft(const Plan& plan, const std::vector<std::optional<double>>& seconds_of_job);

}  // namespace plumbline
