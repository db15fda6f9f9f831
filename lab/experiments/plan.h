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
  // All inputs of the result as text: program, sequence, arguments. A job is done while the folder
  // has the result of the same key.
  std::string key;
  std::filesystem::path reversed;  // folder of the reversed sequence; empty: not reversed
  bool computed = false;           // true for a computed experiment: it writes its own tables
  double computing_s = 0;          // its approximate duration
};

// All jobs of an experiment.
struct Plan {
  Experiment experiment;
  std::vector<ExperimentSequence> sequences;  // those with a job
  std::vector<std::string> missing;           // sequences not found (FoundSequences)
  std::vector<Job> jobs;                      // by sequence, then variant, then run
  bool found_recorded = false;                // true if a recorded sequence is there, chosen or not
  std::string missing_note;                   // one line about `missing`; empty without any
  std::vector<std::string> setting_notes;  // a line for each of the request that variants replace
  std::filesystem::path out, cache;

  const ExperimentSequence& SequenceOf(const Job& job) const { return sequences[job.sequence]; }
  const Variant& VariantOf(const Job& job) const { return experiment.variants[job.variant]; }
  // "euroc/MH_01_easy/points/1"
  std::string NameOf(const Job& job) const;
};

struct PlanRequest {
  SequenceSources sources;
  std::filesystem::path out;
  std::optional<int> runs = std::nullopt;  // nullopt: the number of the experiment
  // Sequences and variants to keep, any of these: part of SEQUENCE/VARIANT, or a pattern with * and
  // ? for all of it. Empty: all.
  std::vector<std::string> only = {};
  // KEY=VALUE for all runs; a variant's own settings take precedence (Plan::setting_notes).
  std::vector<std::string> settings = {};
  std::string program;                                // ProgramId
  std::optional<std::string> earlier = std::nullopt;  // ProgramId, for variants that are by_earlier
  bool full = false;  // the runs of the papers' protocol, without Experiment::test_arguments
};

// Lists the jobs of an experiment. Throws InputError if a setting is wrong or all chosen variants
// replace it, nothing is found, `only` leaves nothing, or only one of `earlier` and a variant that
// is by_earlier is given.
Plan MakePlan(const Experiment& experiment, const PlanRequest& request);

// Returns the plan of an experiment that computes by itself: one job, in the folder of the
// experiment.
Plan MakePlan(const ComputedExperiment& experiment,
              const std::filesystem::path& out,
              int repeats,
              const std::string& program);

// Returns the approximate seconds of a job on two cores of the usual machine, by the number of
// images.
double EstimatedSeconds(const Plan& plan, const Job& job);

// Identifies a build of a program: size and checksum of its file. Throws InputError if it cannot be
// read.
std::string ProgramId(const std::filesystem::path& program);

// Returns the result in the folder of a finished job; nullopt if it is missing or incomplete. That
// of a computed experiment has no figures here.
std::optional<RunFigures> ReadResult(const Job& job);

// Returns true if the folder of a job has its result.
bool IsDone(const Job& job);
// Mark the result in the folder of a job as complete, or as incomplete.
void MarkDone(const Job& job);
void MarkUndone(const Job& job);

}  // namespace plumbline
