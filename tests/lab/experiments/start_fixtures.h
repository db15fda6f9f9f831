// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/plan.h"
#include "lab/experiments/start_pools.h"

#include "tests/lab/experiments/experiment_fixtures.h"
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Two variants, one run each, on two sequences that make a pool; another pool finds nothing.
inline Plan PlanOfStarts(const ScratchFolder& folder) {
  WriteSequenceFolder(folder, "data/euroc/a");
  WriteSequenceFolder(folder, "data/euroc/b");
  Experiment experiment = TwoVariants();
  experiment.command = RunCommandKind::kStarts;
  experiment.variants = {{"one", {}}, {"two", {}}};
  experiment.metrics = {"starts", "success", "wrong", "rotation_error", "add_ms"};
  experiment.plots = {"success"};
  experiment.runs = 1;
  experiment.pools = {{"real", {"euroc/*"}}, {"synthetic", {"worlds/*"}}};
  return MakePlan(experiment, RequestIn(folder));
}

// A possible start with a map after these seconds; nullopt: without.
inline StartRecord StartAfter(std::optional<double> seconds, double rotation_deg = 0.1) {
  StartRecord record;
  record.greatest_parallax_deg = 5;
  record.reason = "ambiguous";
  if (!seconds) return record;
  record.reason = "";
  record.outcome = StartOutcome::kRight;
  record.map = StartMap{};
  record.map->seconds = *seconds;
  record.map->errors.rotation_deg = rotation_deg;
  record.map->errors.direction_deg = 1;
  return record;
}

// By job: a/one, a/two, b/one, b/two.
inline StartsByJob StartsOfTwo() {
  return {{StartAfter(0.1), StartAfter(0.2)},
          {StartAfter(1.5)},
          {StartAfter(std::nullopt), StartAfter(0.4, 0.3)},
          {StartAfter(std::nullopt)}};
}

// The figures and files that jobs with these starts leave behind.
inline std::vector<JobResult> LeaveStarts(const Plan& plan, const StartsByJob& starts) {
  std::vector<JobResult> results;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    std::filesystem::create_directories(plan.jobs[i].folder);
    std::ofstream(plan.jobs[i].folder / "starts.csv") << FormatStarts(starts[i]);
    RunFigures figures;
    figures.values = {{"success", 50}, {"add_ms", 2}};
    figures.trajectory = FormatStarts(starts[i]);
    results.push_back({figures, ""});
  }
  return results;
}

}  // namespace plumbline
