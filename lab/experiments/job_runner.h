// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

// How far an experiment is.
struct RunnerState {
  std::size_t done = 0, total = 0, failed = 0;
  std::string current;  // "euroc/MH_01_easy/points/1", or what is rendered
  std::optional<double> seconds_left;
};

struct RunnerOptions {
  std::filesystem::path program;  // ours
  int jobs = 1;                   // at once
  bool force = false;             // run again what is done
  // Of one job; nullopt: a minute and a second for each frame. What takes longer is killed.
  std::optional<double> time_limit_s = std::nullopt;
  std::function<void(const RunnerState&)> progress = {};  // called often
  std::function<bool()> stop = {};                        // asked often; true ends all
};

// Does the jobs of a plan that are not done: renders the worlds they need, then starts the program
// for each.
//
// A job that crashes, hangs or fails is a result with a reason; the next call tries it again. The
// result of a job counts only once its program has ended well, so that whatever ends this function
// in the middle, the next call goes on where it was. The reasons hold no paths.
//
//   returns   a result for each job of the plan; nullopt when told to stop
//   fails     InputError when another process does jobs in the same folder, folders cannot be
//             written, or a world cannot be rendered
std::optional<std::vector<JobResult>> RunJobs(const Plan& plan, const RunnerOptions& options);

// Time that the jobs without a time will take, one after the other: for each the mean of those of
// the same sequence and variant, else of the same sequence, else of all. nullopt when none has one.
std::optional<double> SecondsLeft(const Plan& plan,
                                  const std::vector<std::optional<double>>& seconds_of_job);

}  // namespace plumbline
