// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/plan.h"

#include "lab/experiments/reversed_sequence.h"
#include "lab/rivals/laboratory_methods.h"
#include "lab/starts/start_bench.h"
#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/slam/options.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

const std::string kMark = "job.txt";

template <class Options>
void CheckSettingsAs(const Experiment& experiment, const std::vector<std::string>& settings) {
  Options options;
  OptionTable table(options, LaboratoryMethods().added);
  for (const std::string& setting : settings) table.Set(setting);
  for (const Variant& variant : experiment.variants) {
    for (const std::string& setting : variant.settings) table.Set(setting);
  }
}

void CheckSettings(const Experiment& experiment, const std::vector<std::string>& settings) {
  if (experiment.command == RunCommandKind::kStarts) {
    CheckSettingsAs<StartOptions>(experiment, settings);
  } else {
    CheckSettingsAs<SlamOptions>(experiment, settings);
  }
}

void CheckEarlier(const Experiment& experiment, const PlanRequest& request) {
  const auto& variants = experiment.variants;
  const bool wanted = std::any_of(
      variants.begin(), variants.end(), [](const Variant& variant) { return variant.by_earlier; });
  if (wanted && !request.earlier) {
    throw InputError(experiment.name + ": expected --earlier PROGRAM, found none");
  }
  if (!wanted && request.earlier) {
    throw InputError(experiment.name +
                     ": takes no --earlier; no variant of it is run by another program");
  }
}

bool IsChosen(const std::string& name, const std::vector<std::string>& only) {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& pattern) {
           const bool wild = pattern.find_first_of("*?") != std::string::npos;
           return wild ? MatchesPattern(name, pattern) : name.find(pattern) != std::string::npos;
         });
}

// Folder of the reversed sequence. Different sequences of one name have different folders.
std::filesystem::path ReversedFolder(const ExperimentSequence& sequence,
                                     const PlanRequest& request) {
  const std::string& identity = sequence.identity;
  const std::uint32_t checksum =
      Crc32(std::span(reinterpret_cast<const std::uint8_t*>(identity.data()), identity.size()));
  return request.sources.cache / "reversed" / sequence.name / fmt::format("{:08x}", checksum);
}

Job MakeJob(const ExperimentSequence& sequence,
            const Variant& variant,
            int run,
            const Experiment& experiment,
            const PlanRequest& request) {
  std::vector<std::string> arguments = {"--seed", std::to_string(run)};
  // Run k leaves out the k - 1 frames that are played first.
  arguments.insert(arguments.end(), {"--from", std::to_string(run - 1)});
  arguments.insert(arguments.end(), sequence.arguments.begin(), sequence.arguments.end());
  arguments.insert(arguments.end(), variant.arguments.begin(), variant.arguments.end());
  if (!request.full) {
    const auto& of_test = experiment.test_arguments;
    arguments.insert(arguments.end(), of_test.begin(), of_test.end());
  }
  for (const auto* settings : {&request.settings, &variant.settings}) {
    for (const std::string& setting : *settings) {
      arguments.emplace_back("--set");
      arguments.push_back(setting);
    }
  }
  Job job;
  job.run = run;
  job.folder = request.out / "runs" / sequence.name / variant.name / std::to_string(run);
  job.key = fmt::format("program {}\nsequence {}: {}{}\narguments {}\n",
                        variant.by_earlier ? *request.earlier : request.program,
                        sequence.name,
                        sequence.identity,
                        variant.reversed ? ", backwards" : "",
                        fmt::join(arguments, " "));
  const std::string name = experiment.command == RunCommandKind::kStarts ? "starts" : "run";
  if (variant.reversed) job.reversed = ReversedFolder(sequence, request);
  const std::filesystem::path& path = variant.reversed ? job.reversed : sequence.path;
  job.command = {name, path.string(), "--out", job.folder.string(), "--quiet"};
  job.command.insert(job.command.end(), arguments.begin(), arguments.end());
  const bool is_new = experiment.command == RunCommandKind::kRun && !variant.by_earlier;
  if (is_new && std::find(arguments.begin(), arguments.end(), "--imu") == arguments.end()) {
    job.command.insert(job.command.end(), {"--imu", "off"});  // no experiment but its own asks
  }
  if (variant.reversed && sequence.has_truth) {
    job.command.insert(job.command.end(), {"--ground-truth", (path / kReversedTruth).string()});
  }
  return job;
}

// The number of an argument of a job, "--to 100"; nullopt if the job has none.
std::optional<double> NumberOf(const Job& job, const char* argument) {
  const auto at = std::find(job.command.begin(), job.command.end(), argument);
  if (at == job.command.end() || at + 1 == job.command.end()) return std::nullopt;
  return std::stod(*(at + 1));
}

// Of the frames of the sequence those that a job reads.
double FramesOf(const Job& job, double frames) {
  const double end = std::min(frames, NumberOf(job, "--to").value_or(frames));
  const double begin = NumberOf(job, "--from").value_or(0);
  return std::max(0.0, end - begin) / NumberOf(job, "--stride").value_or(1);
}

// "pair: no sequence found for euroc/*, kitti/* in DATA"
std::string NoSequenceFound(const Plan& plan, const PlanRequest& request) {
  return fmt::format(
      "{}: no sequence found for {}{}",
      plan.experiment.name,
      fmt::join(plan.missing, ", "),
      request.sources.data ? " in " + request.sources.data->string() : " without --data");
}

// Returns true if runs of the variant have a value of their own for an option: by a setting, or by
// an argument that wins over settings. Each run has its --seed.
bool Replaces(const Variant& variant, const std::string& key) {
  const auto& arguments = variant.arguments;
  const bool has_mode = std::find(arguments.begin(), arguments.end(), "--mode") != arguments.end();
  return key == "slam.seed" || (key == "slam.mode" && has_mode) ||
         std::any_of(variant.settings.begin(), variant.settings.end(), [&](const std::string& own) {
           return own.starts_with(key + "=");
         });
}

// Appends notes about settings of the request that chosen variants replace. Throws InputError if
// all replace one.
void NoteReplaced(const PlanRequest& request, Plan& plan) {
  std::set<std::size_t> chosen;
  for (const Job& job : plan.jobs) chosen.insert(job.variant);
  for (const std::string& setting : request.settings) {
    const std::string key = setting.substr(0, setting.find('='));
    std::vector<std::string> names;
    for (const std::size_t v : chosen) {
      const Variant& variant = plan.experiment.variants[v];
      if (Replaces(variant, key)) names.push_back(variant.name);
    }
    if (names.empty()) continue;
    const bool one = names.size() == 1;
    const std::string note = fmt::format("{}: --set {} has no effect on {}, which {} {} {}",
                                         plan.experiment.name,
                                         setting,
                                         fmt::join(names, ", "),
                                         one ? "sets" : "set",
                                         key,
                                         one ? "itself" : "themselves");
    if (names.size() == chosen.size()) throw InputError(note + "; no other variant is run");
    plan.setting_notes.push_back(note);
  }
}

[[noreturn]] void FailNothing(const Plan& plan, const PlanRequest& request) {
  if (plan.sequences.empty()) throw InputError(NoSequenceFound(plan, request));
  std::vector<std::string> names;
  for (const ExperimentSequence& sequence : plan.sequences) names.push_back(sequence.name);
  std::vector<std::string> variants;
  for (const Variant& variant : plan.experiment.variants) variants.push_back(variant.name);
  throw InputError(fmt::format("--only {}: expected part of one of {}, with / and one of {}",
                               fmt::join(request.only, " --only "),
                               fmt::join(names, ", "),
                               fmt::join(variants, ", ")));
}

}  // namespace

std::string Plan::NameOf(const Job& job) const {
  return fmt::format("{}/{}/{}", SequenceOf(job).name, VariantOf(job).name, job.run);
}

Plan MakePlan(const Experiment& experiment, const PlanRequest& request) {
  CheckEarlier(experiment, request);
  CheckSettings(experiment, request.settings);
  FoundSequences found = FindSequences(experiment.sequences, request.sources);
  Plan plan;
  plan.experiment = experiment;
  plan.missing = std::move(found.missing);
  plan.found_recorded = std::any_of(found.sequences.begin(),
                                    found.sequences.end(),
                                    [](const auto& sequence) { return !sequence.rendered; });
  if (!plan.missing.empty()) {
    plan.missing_note = NoSequenceFound(plan, request) +
                        (plan.found_recorded ? "; left out" : "; only rendered ones are run");
  }
  plan.out = request.out;
  plan.cache = request.sources.cache;
  const int usual = request.full ? experiment.full_runs.value_or(experiment.runs) : experiment.runs;
  const int runs = request.runs.value_or(usual);
  for (ExperimentSequence& sequence : found.sequences) {
    std::vector<Job> jobs;
    for (std::size_t v = 0; v < experiment.variants.size(); ++v) {
      const Variant& variant = experiment.variants[v];
      if (!IsChosen(sequence.name + "/" + variant.name, request.only)) continue;
      for (int run = 1; run <= runs; ++run) {
        jobs.push_back(MakeJob(sequence, variant, run, experiment, request));
        jobs.back().variant = v;
        jobs.back().sequence = plan.sequences.size();
      }
    }
    if (jobs.empty()) continue;
    plan.sequences.push_back(sequence);
    plan.jobs.insert(plan.jobs.end(), jobs.begin(), jobs.end());
  }
  if (plan.jobs.empty()) {
    plan.sequences = std::move(found.sequences);
    FailNothing(plan, request);
  }
  NoteReplaced(request, plan);
  return plan;
}

Plan MakePlan(const ComputedExperiment& experiment,
              const fs::path& out,
              int repeats,
              const std::string& program) {
  Plan plan;
  plan.experiment.name = experiment.name;
  plan.experiment.help = experiment.help;
  plan.experiment.command = RunCommandKind::kComputed;
  plan.experiment.variants = {{"computed", {}}};
  plan.experiment.exclusive = experiment.exclusive;
  plan.out = out;
  ExperimentSequence computed;
  computed.name = experiment.name;
  plan.sequences = {computed};
  Job job;
  job.folder = out;
  job.computed = true;
  job.computing_s = experiment.repeat_s * repeats;
  job.key = fmt::format("program {}\ncomputes {}\nrepeats {}\n", program, experiment.name, repeats);
  job.command = {"experiment",
                 experiment.name,
                 "--runs",
                 std::to_string(repeats),
                 "--out",
                 out.string(),
                 "--quiet"};
  plan.jobs = {job};
  return plan;
}

double EstimatedSeconds(const Plan& plan, const Job& job) {
  // Measured on two cores.
  constexpr double kStart = 0.5, kFrame = 0.015, kMegapixel = 0.08, kOfUnknown = 300;
  constexpr double kStartsFactor = 6, kStartEvery = 5;
  if (job.computed) return job.computing_s;
  const ExperimentSequence& sequence = plan.SequenceOf(job);
  const double frames = sequence.frames > 0 ? static_cast<double>(sequence.frames) : kOfUnknown;
  const bool starts = plan.experiment.command == RunCommandKind::kStarts;
  const double every = NumberOf(job, "--every").value_or(kStartEvery);
  return kStart + (starts ? kStartsFactor * kStartEvery / every : 1) * FramesOf(job, frames) *
                      (kFrame + kMegapixel * sequence.megapixels);
}

std::string ProgramId(const fs::path& program) {
  std::ifstream file(program, std::ios::binary);
  std::vector<std::uint8_t> block(1 << 20);
  std::uint32_t checksum = 0;
  std::uint64_t size = 0;
  while (file) {
    file.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    checksum = Crc32(std::span(block.data(), count), checksum);
    size += count;
  }
  if (size == 0) throw InputError("cannot read the program " + program.string());
  return fmt::format("{} bytes, checksum {:08x}", size, checksum);
}

std::optional<RunFigures> ReadResult(const Job& job) {
  if (!job.computed) return ReadFigures(job.folder);
  std::error_code error;
  if (!fs::is_regular_file(job.folder / "results.json", error)) return std::nullopt;
  return RunFigures{};
}

bool IsDone(const Job& job) {
  return ReadFileIfThere(job.folder / kMark) == job.key && ReadResult(job).has_value();
}

void MarkDone(const Job& job) { WriteFileAtomically(job.folder / kMark, job.key); }

void MarkUndone(const Job& job) {
  std::error_code error;
  fs::remove(job.folder / kMark, error);
  if (error) {
    throw InputError("cannot remove " + (job.folder / kMark).string() + ": " + error.message());
  }
}

}  // namespace plumbline
