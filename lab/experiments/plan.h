// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/computed_experiment.h"
#include "lab/experiments/experiment.h"
#include "lab/experiments/metrics.h"
#include "lab/experiments/sequences.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// One run of one variant on one sequence, by a program of its own.
struct Job {
  std::size_t sequence = 0, variant = 0;  // in the plan
  int run = 1;  // run k has seed k and leaves out the k - 1 frames played first
  std::vector<std::string> command;  // the arguments of the program: "run", PATH, ...
  std::filesystem::path folder;      // OUT/runs/<sequence>/<variant>/<run>
  // All that the result depends on, as text: program, sequence, arguments. A job is done while the
  // folder holds the result of the same key.
  std::string key;
  std::filesystem::path reversed;  // folder to write the sequence backwards into; empty: as it is
  bool computed = false;   // of an experiment that computes by itself: it writes its own tables
  double computing_s = 0;  // what that takes, roughly
};

// All that is to be done for an experiment.
struct Plan {
  Experiment experiment;
  std::vector<ExperimentSequence> sequences;  // those with a job
  std::vector<std::string> missing;           // that nothing was found for (FoundSequences)
  std::vector<Job> jobs;                      // by sequence, then variant, then run
  std::filesystem::path out, cache;

  const ExperimentSequence& SequenceOf(const Job& job) const { return sequences[job.sequence]; }
  const Variant& VariantOf(const Job& job) const { return experiment.variants[job.variant]; }
  // "euroc/MH_01_easy/points/1"
  std::string NameOf(const Job& job) const;
};

struct PlanRequest {
  SequenceSources sources;
  std::filesystem::path out;
  std::optional<int> runs = std::nullopt;  // nullopt: as the experiment has it
  // Sequences and variants to keep, any of these: part of SEQUENCE/VARIANT, or a pattern with * and
  // ? for all of it. Empty: all.
  std::vector<std::string> only = {};
  // KEY=VALUE for all runs; what a variant sets itself goes before it.
  std::vector<std::string> settings = {};
  std::string program;                                // ProgramId
  std::optional<std::string> earlier = std::nullopt;  // ProgramId, of variants that are by_earlier
  bool full = false;  // the runs of the papers' protocol, without Experiment::test_arguments
};

// Lists the jobs of an experiment. Throws InputError where a setting is wrong, nothing is found,
// `only` leaves nothing, or `earlier` is there without a variant that is by_earlier, or the other
// way round.
Plan MakePlan(const Experiment& experiment, const PlanRequest& request);

// The plan of an experiment that computes by itself: one job, the program computing it, whose
// folder is that of the experiment.
Plan MakePlan(const ComputedExperiment& experiment,
              const std::filesystem::path& out,
              int repeats,
              const std::string& program);

// Seconds that a job takes on two cores of the usual machine, roughly: by the images it is to read.
double EstimatedSeconds(const Plan& plan, const Job& job);

// Tells builds of a program apart: size and checksum of its file. Throws InputError when it cannot
// be read.
std::string ProgramId(const std::filesystem::path& program);

// What is in the folder of a job that has ended well; nullopt where its result is missing or not
// whole. That of a computed experiment has no figures here.
std::optional<RunFigures> ReadResult(const Job& job);

// Whether the folder of a job holds its result.
bool IsDone(const Job& job);
// Marks the result in the folder of a job as whole, or as not.
void MarkDone(const Job& job);
void MarkUndone(const Job& job);

}  // namespace plumbline
