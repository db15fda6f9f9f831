// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/catalog.h"
#include "lab/experiments/computed.h"
#include "lab/experiments/metrics.h"
#include "lab/experiments/paper_catalog.h"
#include "plumbline/base/error.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/experiment_runs.h"
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

CommandSyntax ExperimentSyntax() {
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
           {"--earlier",
            "PROGRAM",
            "another version of the program, which `versions` compares this one with"},
           {"--full", "", "the papers' protocol: worlds as they are, and all runs"},
           {"--jobs",
            "N",
            "runs at once (1, with a group of experiments as many as there are cores); more than "
            "one spoils times, so those that measure them run alone"},
           {"--executor", "local|slurm", "where runs go (local): this machine, or a cluster"},
           {"--sbatch", "ARG", "one more argument of sbatch, with slurm; may be repeated"},
           {"--memory", "MB", "the most that a run may have"},
           {"--retries", "N", "how often a run that crashes is tried again (1)"},
           {"--time-limit",
            "S",
            "kill a run after so many seconds (60, and one for each frame; six with starts)"},
           {"--force", "", "run again what is done"},
           {"--dry-run", "", "list the runs and start none"},
           {"--quiet", "", "print nothing but errors"}}};
}

void ListExperiments() {
  for (const Experiment& experiment : Experiments()) {
    std::cout << fmt::format("{:<29}{}\n", experiment.name, experiment.help);
  }
  for (const ComputedExperiment& experiment : ComputedExperiments()) {
    std::cout << fmt::format("{:<29}{}\n", experiment.name, experiment.help);
  }
  for (const ExperimentGroup& group : ExperimentGroups()) {
    std::cout << fmt::format("{:<29}{}\n", group.name, group.help);
  }
}

void ListParts(const ExperimentGroup& group) {
  std::cout << group.name << ": " << group.help << "\n\nexperiments:\n";
  for (const std::string& name : group.experiments) std::cout << "  " << name << "\n";
}

void ListParts(const ComputedExperiment& experiment) {
  std::cout << fmt::format("{}: {}\n\nneeds no sequences; repeats: {}, with --full {}\nmetrics:\n",
                           experiment.name,
                           experiment.help,
                           experiment.repeats,
                           experiment.full_repeats);
  for (const FigureMetric& metric : experiment.metrics) {
    std::cout << fmt::format("  {:<34}{}\n", metric.name, metric.help);
  }
}

void ListParts(const Experiment& experiment) {
  std::cout << experiment.name << ": " << experiment.help << "\n\nsequences:";
  for (const SequenceChoice& choice : experiment.sequences) {
    std::cout << " " << choice.pattern << (choice.label.empty() ? "" : "@" + choice.label);
  }
  for (const SequenceChoice& choice : experiment.sequences) {
    if (choice.source.empty()) continue;
    std::cout << fmt::format("\n  {:<24}{}", choice.paper, choice.source);
  }
  std::cout << "\nruns: " << experiment.runs;
  if (experiment.full_runs) std::cout << ", with --full " << *experiment.full_runs;
  std::cout << "\nvariants:\n";
  for (const Variant& variant : experiment.variants) {
    std::cout << fmt::format("  {:<23} {}{}{}{}\n",
                             variant.name,
                             variant.by_earlier ? "(by --earlier PROGRAM) " : "",
                             fmt::join(variant.settings, " "),
                             variant.arguments.empty() ? "" : " ",
                             fmt::join(variant.arguments, " "));
  }
  std::cout << "metrics:\n";
  for (const std::string& name : experiment.metrics) {
    std::cout << fmt::format("  {:<20}{}\n", name, FindMetric(name)->help);
  }
}

}  // namespace

int ExperimentCommand(std::span<const std::string> arguments) {
  const CommandLine line(ExperimentSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(ExperimentSyntax());
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
  const bool list = line.Has("--list");
  if (const ComputedExperiment* computed = FindComputedExperiment(name)) {
    if (!list) return RunComputed(*computed, line);
    ListParts(*computed);
    return 0;
  }
  if (const ExperimentGroup* group = FindExperimentGroup(name)) {
    if (!list) return RunGroup(*group, line);
    ListParts(*group);
    return 0;
  }
  const Experiment& experiment = FindExperiment(name);
  if (!list) return RunExperiment(experiment, line);
  ListParts(experiment);
  return 0;
}

}  // namespace plumbline
