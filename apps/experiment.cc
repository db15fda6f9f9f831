// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"
#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"
#include "lab/experiments/results.h"
#include "plumbline/base/error.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/progress.h"
#include "apps/stop_signal.h"
#include <filesystem>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

constexpr const char* kProgram = "/proc/self/exe";
// The most that may be asked for. A run is one of a variant on a sequence, a repeat a part of what
// is computed.
constexpr int kMostRuns = 1000, kMostRepeats = 100'000, kMostJobs = 1000;
constexpr int kLongestRun = 10'000'000;  // seconds, 116 days

CommandSyntax Syntax() {
  return {"experiment",
          "Runs every variant of an experiment on every sequence, several times, and makes tables "
          "and plots.\nGoes on where it stopped; what is done already is not run again.",
          {"[NAME]"},
          {{"--list", "", "list the experiments; with NAME, what it is made of"},
           {"--data", "DIR", "folder with the folders of recorded sequences (euroc, kitti, ...)"},
           {"--out", "DIR", "folder for results and runs"},
           {"--cache", "DIR", "folder for rendered sequences (default: OUT/sequences)"},
           {"--size",
            "test|full",
            "of rendered sequences: 376x240 and at most 150 frames, or as the world has it (the "
            "experiment's own)"},
           {"--runs",
            "N",
            "runs of each variant on each sequence, or repeats of what is computed (the "
            "experiment's own)"},
           {"--only",
            "PATTERN",
            "sequences and variants that have this in SEQUENCE/VARIANT, or "
            "fit it, with * and ?; may be repeated"},
           {"--set", "KEY=VALUE", "one option for all runs; may be repeated"},
           {"--jobs", "N", "runs at once (1); more than one spoils the times"},
           {"--time-limit",
            "S",
            "kill a run after so many seconds (60, and one for each frame; six with starts)"},
           {"--force", "", "run again what is done"},
           {"--dry-run", "", "list the runs and start none"},
           {"--quiet", "", "print nothing but errors"}}};
}

void ListExperiments() {
  for (const Experiment& experiment : Experiments()) {
    std::cout << fmt::format("{:<24}{}\n", experiment.name, experiment.help);
  }
  for (const ComputedExperiment& experiment : ComputedExperiments()) {
    std::cout << fmt::format("{:<24}{}\n", experiment.name, experiment.help);
  }
}

void ListParts(const ComputedExperiment& experiment) {
  std::cout << fmt::format("{}: {}\n\nneeds no sequences; repeats: {}\nmetrics:\n",
                           experiment.name,
                           experiment.help,
                           experiment.repeats);
  for (const FigureMetric& metric : experiment.metrics) {
    std::cout << fmt::format("  {:<34}{}\n", metric.name, metric.help);
  }
}

void ListParts(const Experiment& experiment) {
  std::cout << experiment.name << ": " << experiment.help << "\n\nsequences:";
  for (const SequenceChoice& choice : experiment.sequences) {
    std::cout << " " << choice.pattern << (choice.label.empty() ? "" : "@" + choice.label);
  }
  std::cout << "\nruns: " << experiment.runs << "\nvariants:\n";
  for (const Variant& variant : experiment.variants) {
    std::cout << fmt::format("  {:<23} {}{}{}\n",
                             variant.name,
                             fmt::join(variant.settings, " "),
                             variant.arguments.empty() ? "" : " ",
                             fmt::join(variant.arguments, " "));
  }
  std::cout << "metrics:\n";
  for (const std::string& name : experiment.metrics) {
    std::cout << fmt::format("  {:<20}{}\n", name, FindMetric(name)->help);
  }
}

PlanRequest ReadRequest(const CommandLine& line, const Experiment& experiment) {
  PlanRequest request;
  const auto out = line.Value("--out");
  if (!out) throw InputError("experiment: expected --out DIR");
  request.out = *out;
  if (const auto data = line.Value("--data")) request.sources.data = *data;
  request.sources.cache = line.Value("--cache").value_or((request.out / "sequences").string());
  request.sources.size = experiment.size;
  if (const auto size = line.Value("--size")) {
    request.sources.size = ParseChoice<WorldSize>("--size", *size);
  }
  if (line.Has("--runs")) request.runs = line.Count("--runs", 1, {1, kMostRuns});
  request.only = line.Values("--only");
  request.settings = line.Values("--set");
  request.program = ProgramId(kProgram);
  return request;
}

void ListJobs(const Plan& plan, bool force) {
  for (const Job& job : plan.jobs) {
    std::cout << fmt::format("{}  {}: plumbline {}\n",
                             !force && IsDone(job) ? "done" : "run ",
                             plan.NameOf(job),
                             fmt::join(job.command, " "));
  }
}

std::string Duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

RunnerOptions ReadRunnerOptions(const CommandLine& line) {
  RunnerOptions options;
  options.program = std::filesystem::read_symlink(kProgram);
  options.jobs = line.Count("--jobs", 1, {1, kMostJobs});
  options.force = line.Has("--force");
  if (line.Has("--time-limit")) {
    options.time_limit_s = line.Count("--time-limit", 1, {1, kLongestRun});
  }
  options.stop = StopRequested;
  return options;
}

int Run(const Plan& plan, RunnerOptions options, bool quiet) {
  ProgressLine progress(quiet);
  options.progress = [&](const RunnerState& state) {
    progress.Show(state.done,
                  state.total,
                  fmt::format("{}/{} runs{}  ETA {}  {}",
                              state.done,
                              state.total,
                              state.failed > 0 ? fmt::format("  {} failed", state.failed) : "",
                              state.seconds_left ? Duration(*state.seconds_left) : "?",
                              state.current));
  };
  CatchStopSignals();
  const auto results = RunJobs(plan, options);
  if (!results) {
    progress.Say("stopped; the same command goes on");
    return FirstStopSignal()->exit_code;
  }
  WriteResults(plan, *results);
  if (quiet) return 0;
  std::size_t failed = 0;
  for (const JobResult& result : *results) failed += !result.figures;
  std::cout << fmt::format("{} runs{}; results in {}\n",
                           results->size(),
                           failed > 0 ? fmt::format(", {} failed", failed) : "",
                           (plan.out / "table.html").string());
  return 0;
}

// Flags that are about sequences and runs have no meaning here.
void RefuseFlagsOfRuns(const CommandLine& line, const std::string& name) {
  for (const char* flag : {"--data",
                           "--cache",
                           "--size",
                           "--only",
                           "--set",
                           "--jobs",
                           "--time-limit",
                           "--force",
                           "--dry-run"}) {
    if (line.Has(flag)) {
      throw InputError(
          fmt::format("experiment {}: computes by itself and takes no {}", name, flag));
    }
  }
}

int RunComputed(const ComputedExperiment& experiment, const CommandLine& line) {
  if (line.Has("--list")) {
    ListParts(experiment);
    return 0;
  }
  RefuseFlagsOfRuns(line, experiment.name);
  const auto out = line.Value("--out");
  if (!out) throw InputError("experiment: expected --out DIR");
  const int repeats = line.Count("--runs", experiment.repeats, {1, kMostRepeats});
  const bool quiet = line.Has("--quiet");
  ProgressLine progress(quiet);
  CatchStopSignals();
  const bool done = experiment.run(experiment, repeats, *out, [&](std::size_t at, std::size_t all) {
    progress.Show(at, all, fmt::format("{}/{} parts", at, all));
    return !StopRequested();
  });
  if (!done) {
    progress.Say("stopped; nothing is written");
    return FirstStopSignal()->exit_code;
  }
  if (!quiet) {
    std::cout << fmt::format("results in {}\n",
                             (std::filesystem::path(*out) / "table.html").string());
  }
  return 0;
}

}  // namespace

int ExperimentCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(Syntax());
    return 0;
  }
  const std::string& name = line.Positional(0);
  if (line.Has("--list") && name.empty()) {
    ListExperiments();
    return 0;
  }
  if (name.empty()) {
    throw InputError(
        "experiment: expected the name of one; plumbline experiment --list shows them");
  }
  if (const ComputedExperiment* computed = FindComputedExperiment(name)) {
    return RunComputed(*computed, line);
  }
  const Experiment& experiment = FindExperiment(name);
  if (line.Has("--list")) {
    ListParts(experiment);
    return 0;
  }
  const bool quiet = line.Has("--quiet");
  const RunnerOptions options = ReadRunnerOptions(line);
  const Plan plan = MakePlan(experiment, ReadRequest(line, experiment));
  for (const std::string& pattern : plan.missing) {
    if (!quiet) std::cerr << "plumbline: no sequence " << pattern << " found; left out\n";
  }
  if (line.Has("--dry-run")) {
    ListJobs(plan, options.force);
    return 0;
  }
  return Run(plan, options, quiet);
}

}  // namespace plumbline
