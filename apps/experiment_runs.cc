// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/experiment_runs.h"

#include "lab/experiments/gate.h"
#include "lab/experiments/group_report.h"
#include "lab/experiments/job_runner.h"
#include "lab/experiments/paper_catalog.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/results_folder.h"
#include "lab/experiments/slurm_executor.h"
#include "lab/experiments/write_results.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include "apps/progress.h"
#include "apps/stop_signal.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {

// Executors of the command line.
enum class ExecutorKind { kLocal, kSlurm };
constexpr auto EnumNames(std::type_identity<ExecutorKind>) {
  return std::array{std::pair{ExecutorKind::kLocal, "local"},
                    std::pair{ExecutorKind::kSlurm, "slurm"}};
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "/proc/self/exe";
// Upper limits of options. A run is one of a variant on a sequence, a repeat a part of a
// computation.
constexpr int kMostRuns = 1000, kMostRepeats = 100'000, kMostJobs = 1000, kMostRetries = 100;
constexpr int kLongestRun = 10'000'000;                     // seconds, 116 days
constexpr int kLeastMemory = 1, kMostMemory = 1024 * 1024;  // MB
constexpr const char* kSequences = "sequences";

ExecutorKind ReadExecutor(const CommandLine& line) {
  const auto name = line.Value("--executor");
  return name ? ParseChoice<ExecutorKind>("--executor", *name) : ExecutorKind::kLocal;
}

fs::path ReadOut(const CommandLine& line) {
  const auto out = line.Value("--out");
  if (!out) throw InputError("experiment: expected --out DIR");
  return *out;
}

// Machines of a cluster see the folders from wherever they start.
fs::path Placed(const fs::path& path, const CommandLine& line) {
  return ReadExecutor(line) == ExecutorKind::kSlurm ? fs::absolute(path) : path;
}

PlanRequest ReadRequest(const CommandLine& line,
                        const Experiment& experiment,
                        const fs::path& out,
                        const std::string& program) {
  PlanRequest request;
  request.out = Placed(out, line);
  if (const auto data = line.Value("--data")) request.sources.data = Placed(*data, line);
  request.sources.cache =
      Placed(line.Value("--cache").value_or((ReadOut(line) / kSequences).string()), line);
  request.full = line.Has("--full");
  request.sources.size = request.full ? WorldSize::kFull : experiment.size;
  if (const auto size = line.Value("--size")) {
    request.sources.size = ParseChoice<WorldSize>("--size", *size);
  }
  if (line.Has("--runs")) request.runs = line.Count("--runs", 1, {1, kMostRuns});
  request.only = line.Values("--only");
  request.settings = line.Values("--set");
  request.program = program;
  if (const auto earlier = line.Value("--earlier")) request.earlier = ProgramId(*earlier);
  return request;
}

std::string Duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

RunnerOptions ReadRunnerOptions(const CommandLine& line) {
  RunnerOptions options;
  options.program = fs::read_symlink(kProgram);
  // A name without a folder would be looked for among the installed programs.
  if (const auto earlier = line.Value("--earlier")) options.earlier = fs::absolute(*earlier);
  options.force = line.Has("--force");
  options.retries = line.Count("--retries", 1, {0, kMostRetries});
  if (line.Has("--memory")) {
    options.memory_mb = line.Count("--memory", 1, {kLeastMemory, kMostMemory});
  }
  if (line.Has("--time-limit")) {
    options.time_limit_s = line.Count("--time-limit", 1, {1, kLongestRun});
  }
  options.stop = StopRequested;
  return options;
}

int ReadJobs(const CommandLine& line, int usual) {
  return line.Count("--jobs", usual, {1, kMostJobs});
}

// Flags that only one executor knows.
void CheckExecutorFlags(const CommandLine& line) {
  const bool slurm = ReadExecutor(line) == ExecutorKind::kSlurm;
  if (slurm && line.Has("--jobs")) {
    throw InputError("--jobs: expected with --executor local; Slurm knows how many may run");
  }
  if (!slurm && line.Has("--sbatch")) {
    throw InputError("--sbatch: expected with --executor slurm");
  }
}

std::unique_ptr<JobExecutor> MakeExecutor(const CommandLine& line, int jobs) {
  if (ReadExecutor(line) == ExecutorKind::kLocal) return std::make_unique<LocalExecutor>(jobs);
  return std::make_unique<SlurmExecutor>(
      SlurmOptions{fs::absolute(ReadOut(line)) / "slurm", line.Values("--sbatch")});
}

// The plans of a group's experiments. Experiments without a plan have `trouble` set.
struct PlannedGroup {
  std::vector<Plan> plans;
  std::vector<GroupPart> parts;  // in the order of the group
  std::vector<std::size_t> part_of_plan;
};

// Reports notes about sequences and settings before the runs.
void SayNotes(const Plan& plan, bool quiet) {
  if (quiet) return;
  if (!plan.missing_note.empty()) std::clog << "plumbline: " << plan.missing_note << '\n';
  for (const std::string& note : plan.setting_notes) std::clog << "plumbline: " << note << '\n';
}

// Reports notes of all plans of a group; missing sequences are listed in the group's report.
void SayNotes(const PlannedGroup& group, const std::optional<std::string>& data, bool quiet) {
  if (quiet) return;
  bool asked = false, found = false;  // for and of recorded sequences
  for (const Plan& plan : group.plans) {
    asked = asked || !plan.missing.empty();
    found = found || plan.found_recorded;
  }
  if (data && asked && !found) {
    std::clog << fmt::format(
        "plumbline: {}: no recorded sequence found; only rendered ones are run\n", *data);
  }
  for (const Plan& plan : group.plans) {
    for (const std::string& note : plan.setting_notes) std::clog << "plumbline: " << note << '\n';
  }
}

int ListJobs(const std::vector<const Plan*>& plans, bool force) {
  std::size_t total = 0, done = 0;
  double seconds = 0;
  for (const Plan* plan : plans) {
    for (const Job& job : plan->jobs) {
      const bool is_done = !force && IsDone(job);
      ++total;
      done += is_done;
      if (!is_done) seconds += EstimatedSeconds(*plan, job);
      std::cout << fmt::format("{}  {}: plumbline {}\n",
                               is_done ? "done" : "run ",
                               plan->NameOf(job),
                               fmt::join(job.command, " "));
    }
  }
  std::cout << fmt::format("{} runs, {} done; the others take about {}, one after the other\n",
                           total,
                           done,
                           Duration(seconds));
  return 0;
}

// The runs of some plans, with progress. `finished` is called when all of a plan have ended.
// nullopt when told to stop.
std::optional<std::vector<std::vector<JobResult>>> RunWithProgress(
    const std::vector<const Plan*>& plans,
    const CommandLine& line,
    int usual_jobs,
    const PlanFinished& finished) {
  RunnerOptions options = ReadRunnerOptions(line);
  ProgressLine progress(line.Has("--quiet"));
  options.progress = [&](const RunnerState& state) {
    progress.Show(state.done,
                  state.total,
                  fmt::format("{}/{} runs  {} running{}  {} left  {}",
                              state.done,
                              state.total,
                              state.running,
                              state.failed > 0 ? fmt::format("  {} failed", state.failed) : "",
                              Duration(state.seconds_left),
                              state.current));
  };
  CatchStopSignals();
  MakeFolder(ReadOut(line));  // before anything is submitted
  const auto executor = MakeExecutor(line, ReadJobs(line, usual_jobs));
  auto results = RunPlans(plans, Placed(ReadOut(line), line), *executor, options, finished);
  if (!results) {
    const std::string rest = executor->WhatGoesOn();
    progress.Say("stopped; the same command goes on" + (rest.empty() ? "" : "; " + rest));
  }
  return results;
}

std::size_t CountFailed(const std::vector<JobResult>& results) {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const JobResult& r) { return !r.figures; }));
}

std::string SayRuns(std::size_t runs, std::size_t failed, const fs::path& out) {
  return fmt::format("{} runs{}; results in {}\n",
                     runs,
                     failed > 0 ? fmt::format(", {} failed", failed) : "",
                     (out / "table.html").string());
}

// Returns the exit code for these runs: 1, with a line on stderr, if none succeeded.
int CheckSomeSucceeded(std::size_t runs, std::size_t failed, const fs::path& out) {
  if (runs == 0 || failed < runs) return 0;
  std::clog << "plumbline: no run succeeded; " << (out / "table.md").string() << " says why\n";
  return 1;
}

// Compares the figures with the limits, if any; they go into gate.md too.
int CheckLimits(const Plan& plan, const std::vector<JobResult>& results, bool quiet) {
  const std::vector<GateLimit> limits = GateLimitsOf(plan.experiment.name);
  if (limits.empty()) return 0;
  const std::vector<GateCheck> checks = CheckGate(limits, plan, results);
  const std::string text = FormatGate(checks);
  WriteFileAtomically(plan.out / "gate.md", text);
  const auto broken = std::count_if(
      checks.begin(), checks.end(), [](const GateCheck& check) { return !check.kept; });
  if (!quiet) std::cout << text;
  if (broken > 0) {
    std::clog << fmt::format("plumbline: {} of {} limits are broken\n", broken, checks.size());
  }
  return broken > 0 ? 1 : 0;
}

// Flags about sequences and runs have no meaning for computed experiments.
void RefuseFlagsOfRuns(const CommandLine& line, const std::string& name) {
  for (const char* flag : {"--data",
                           "--cache",
                           "--size",
                           "--only",
                           "--set",
                           "--earlier",
                           "--jobs",
                           "--time-limit",
                           "--memory",
                           "--retries",
                           "--executor",
                           "--sbatch",
                           "--force",
                           "--dry-run"}) {
    if (line.Has(flag)) {
      throw InputError(
          fmt::format("experiment {}: computes by itself and takes no {}", name, flag));
    }
  }
}

Plan PlanPart(const std::string& name, const CommandLine& line, const std::string& program) {
  const fs::path out = ReadOut(line) / name;
  if (const ComputedExperiment* computed = FindComputedExperiment(name)) {
    const int repeats = line.Has("--full") ? computed->full_repeats : computed->repeats;
    return MakePlan(*computed, Placed(out, line), repeats, program);
  }
  const Experiment& experiment = FindExperiment(name);
  return MakePlan(experiment, ReadRequest(line, experiment, out, program));
}

bool IsChosenPart(const std::string& name, const CommandLine& line) {
  // A computed experiment has no sequences among which --only could choose.
  return line.Values("--only").empty() || FindComputedExperiment(name) == nullptr;
}

PlannedGroup PlanGroup(const ExperimentGroup& group, const CommandLine& line) {
  PlannedGroup planned;
  const std::string program = ProgramId(kProgram);
  std::optional<InputError> first;
  for (const std::string& name : group.experiments) {
    if (!IsChosenPart(name, line)) continue;
    GroupPart part;
    part.name = name;
    try {
      planned.plans.push_back(PlanPart(name, line, program));
      part.help = planned.plans.back().experiment.help;
      planned.part_of_plan.push_back(planned.parts.size());
    } catch (const InputError& error) {
      if (!first) first = error;
      part.trouble = error.what();
      if (!line.Values("--only").empty()) continue;  // not asked for
    }
    planned.parts.push_back(part);
  }
  if (planned.plans.empty() && first) throw *first;
  return planned;
}

}  // namespace

int RunExperiment(const Experiment& experiment, const CommandLine& line) {
  const bool quiet = line.Has("--quiet");
  CheckExecutorFlags(line);
  ReadRunnerOptions(line);  // reports errors before any work
  ReadJobs(line, 1);
  const Plan plan =
      MakePlan(experiment, ReadRequest(line, experiment, ReadOut(line), ProgramId(kProgram)));
  if (!line.Has("--dry-run")) CheckResultsFolder(plan.out);
  SayNotes(plan, quiet);
  if (line.Has("--dry-run")) return ListJobs({&plan}, line.Has("--force"));
  const auto results = RunWithProgress({&plan}, line, 1, {});
  if (!results) return FirstStopSignal()->exit_code;
  WriteResults(plan, results->front());
  const std::size_t runs = results->front().size(), failed = CountFailed(results->front());
  if (!quiet) std::cout << SayRuns(runs, failed, plan.out);
  return std::max(CheckLimits(plan, results->front(), quiet),
                  CheckSomeSucceeded(runs, failed, plan.out));
}

int RunGroup(const ExperimentGroup& group, const CommandLine& line) {
  const bool quiet = line.Has("--quiet");
  CheckExecutorFlags(line);
  ReadRunnerOptions(line);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  ReadJobs(line, cores);
  const auto data = line.Value("--data");
  std::error_code error;
  if (data && !fs::is_directory(*data, error)) {
    throw InputError(*data + ": expected the folder of the sequences, found none");
  }
  PlannedGroup planned = PlanGroup(group, line);
  std::vector<const Plan*> plans;
  for (const Plan& plan : planned.plans) plans.push_back(&plan);
  if (!line.Has("--dry-run")) {
    CheckResultsFolder(ReadOut(line));
    for (const Plan* plan : plans) CheckResultsFolder(plan->out);
  }
  SayNotes(planned, data, quiet);
  if (line.Has("--dry-run")) return ListJobs(plans, line.Has("--force"));
  std::size_t runs = 0, failed = 0;
  const auto results = RunWithProgress(
      plans, line, cores, [&](std::size_t p, const std::vector<JobResult>& of_plan) {
        WriteResults(*plans[p], of_plan);
        planned.parts[planned.part_of_plan[p]] = SummarizePart(*plans[p], of_plan);
        runs += of_plan.size();
        failed += CountFailed(of_plan);
      });
  if (!results) return FirstStopSignal()->exit_code;
  WriteGroupReport(ReadOut(line), group.name, group.help, planned.parts);
  if (!quiet) std::cout << SayRuns(runs, failed, ReadOut(line));
  return CheckSomeSucceeded(runs, failed, ReadOut(line));
}

int RunComputed(const ComputedExperiment& experiment, const CommandLine& line) {
  RefuseFlagsOfRuns(line, experiment.name);
  const fs::path out = ReadOut(line);
  const int usual = line.Has("--full") ? experiment.full_repeats : experiment.repeats;
  const int repeats = line.Count("--runs", usual, {1, kMostRepeats});
  const bool quiet = line.Has("--quiet");
  CheckResultsFolder(out);
  ProgressLine progress(quiet);
  CatchStopSignals();
  const bool done = experiment.run(experiment, repeats, out, [&](std::size_t at, std::size_t all) {
    progress.Show(at, all, fmt::format("{}/{} parts", at, all));
    return !StopRequested();
  });
  if (!done) {
    progress.Say("stopped; nothing is written");
    return FirstStopSignal()->exit_code;
  }
  if (!quiet) std::cout << fmt::format("results in {}\n", (out / "table.html").string());
  return 0;
}

}  // namespace plumbline
