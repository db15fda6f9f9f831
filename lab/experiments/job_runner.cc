// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/job_runner.h"

#include "lab/experiments/child_process.h"
#include "lab/experiments/line_map_figures.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/folder_lock.h"
#include "worlds/sequence_cache.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <list>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPollEvery(10);
const std::string kLog = "log.txt";

// Thrown through the renderer, which knows no other way to end early.
struct Stopped {};

void ReplaceAll(std::string& text, const std::string& what, const std::string& with) {
  if (what.empty()) return;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
}

// The last line that the program of a job said.
std::string LastWords(const Plan& plan, const Job& job) {
  std::ifstream log(job.folder / kLog);
  std::string last, line;
  while (std::getline(log, line)) {
    if (!line.empty()) last = line;
  }
  const std::string prefix = "plumbline: ";
  if (last.starts_with(prefix)) last.erase(0, prefix.size());
  // Where things are does not belong into results.
  ReplaceAll(last, plan.SequenceOf(job).path.string(), plan.SequenceOf(job).name);
  ReplaceAll(last, plan.out.string(), "OUT");
  return last;
}

std::string WhyFailed(const Plan& plan, const Job& job, const ChildProcess::End& end) {
  if (end.signal)
    return fmt::format("ended by signal {} ({})", *end.signal, sigdescr_np(*end.signal));
  const std::string words = LastWords(plan, job);
  if (end.code != 0) return words.empty() ? fmt::format("exit code {}", end.code) : words;
  return "no summary.json";
}

class Runner {
 public:
  Runner(const Plan& plan, const RunnerOptions& options)
      : plan_(plan), options_(options), results_(plan.jobs.size()), seconds_(plan.jobs.size()) {
    state_.total = plan.jobs.size();
  }

  std::optional<std::vector<JobResult>> Run() {
    FindWhatIsDone();
    try {
      RenderWorlds();
    } catch (const Stopped&) {
      return std::nullopt;
    }
    auto next = waiting_.begin();
    while (next != waiting_.end() || !running_.empty()) {
      while (next != waiting_.end() && running_.size() < static_cast<std::size_t>(options_.jobs)) {
        Start(*next++);
      }
      if (IsToStop()) return std::nullopt;  // running_ kills its programs
      std::this_thread::sleep_for(kPollEvery);
      running_.remove_if([this](Running& running) { return HasEnded(running); });
      Show();
    }
    return std::move(results_);
  }

 private:
  struct Running {
    Running(std::size_t index,
            const std::vector<std::string>& command,
            const std::filesystem::path& log)
        : job(index), process(command, log) {}
    std::size_t job;  // in the plan
    ChildProcess process;
    Clock::time_point start = Clock::now();
  };

  bool IsToStop() const { return options_.stop && options_.stop(); }

  void Show() {
    if (!options_.progress) return;
    if (!running_.empty()) state_.current = plan_.NameOf(plan_.jobs[running_.front().job]);
    state_.seconds_left = SecondsLeft(plan_, seconds_);
    if (state_.seconds_left) *state_.seconds_left /= options_.jobs;
    options_.progress(state_);
  }

  void FindWhatIsDone() {
    for (std::size_t i = 0; i < plan_.jobs.size(); ++i) {
      if (options_.force || !IsDone(plan_.jobs[i])) {
        waiting_.push_back(i);
      } else {
        Keep(i, *ReadFigures(plan_.jobs[i].folder));
      }
    }
  }

  void Keep(std::size_t job, RunFigures figures) {
    ++state_.done;
    AddLineMapFigures(plan_.SequenceOf(plan_.jobs[job]).path, plan_.jobs[job].folder, figures);
    const auto wall = figures.values.find("wall_s");
    if (wall != figures.values.end()) seconds_[job] = wall->second;
    results_[job].figures = std::move(figures);
  }

  void RenderWorlds() {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (const std::size_t job : waiting_) {
      const ExperimentSequence& sequence = plan_.SequenceOf(plan_.jobs[job]);
      if (!sequence.rendered) continue;
      const SynthOptions& options = sequence.rendered->options;
      CachedSequence(plan_.cache, sequence.rendered->world, options, threads, [&](int done) {
        if (IsToStop()) throw Stopped();
        state_.current = fmt::format("rendering {}: {} frames", sequence.name, done);
        Show();
      });
    }
  }

  void Start(std::size_t index) {
    const Job& job = plan_.jobs[index];
    MakeFolder(job.folder);
    MarkUndone(job);
    std::vector<std::string> command = {options_.program.string()};
    command.insert(command.end(), job.command.begin(), job.command.end());
    running_.emplace_back(index, command, job.folder / kLog);
    Show();
  }

  double LimitOf(const Job& job) const {
    constexpr double kStart = 60, kFramesOfUnknown = 3600;
    // A frame is offered to all starts of the six seconds before it.
    const double per_frame = plan_.experiment.command == RunCommandKind::kStarts ? 6 : 1;
    const std::size_t frames = plan_.SequenceOf(job).frames;
    return options_.time_limit_s.value_or(
        kStart + per_frame * (frames > 0 ? static_cast<double>(frames) : kFramesOfUnknown));
  }

  bool HasEnded(Running& running) {
    const Job& job = plan_.jobs[running.job];
    const double seconds = std::chrono::duration<double>(Clock::now() - running.start).count();
    const auto end = running.process.Poll();
    if (!end && seconds <= LimitOf(job)) return false;
    auto figures = end && end->code == 0 && !end->signal ? ReadFigures(job.folder) : std::nullopt;
    if (figures) {
      MarkDone(job);
      Keep(running.job, *std::move(figures));
    } else {
      results_[running.job].reason =
          end ? WhyFailed(plan_, job, *end) : fmt::format("no end after {:.0f} s", LimitOf(job));
      ++state_.done;
      ++state_.failed;
    }
    seconds_[running.job] = seconds;
    return true;
  }

  const Plan& plan_;
  const RunnerOptions& options_;
  RunnerState state_;
  std::vector<JobResult> results_;
  std::vector<std::optional<double>> seconds_;  // of the jobs that have ended
  std::vector<std::size_t> waiting_;
  std::list<Running> running_;
};

struct Mean {
  double sum = 0;
  int count = 0;
  void Add(double value) {
    sum += value;
    ++count;
  }
};

}  // namespace

std::optional<std::vector<JobResult>> RunJobs(const Plan& plan, const RunnerOptions& options) {
  MakeFolder(plan.out);
  const FolderLock lock(plan.out, "another experiment is running in this folder");
  return Runner(plan, options).Run();
}

std::optional<double> SecondsLeft(const Plan& plan,
                                  const std::vector<std::optional<double>>& seconds_of_job) {
  std::map<std::pair<std::size_t, std::size_t>, Mean> same;
  std::map<std::size_t, Mean> same_sequence;
  Mean all;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (!seconds_of_job[i]) continue;
    same[{plan.jobs[i].sequence, plan.jobs[i].variant}].Add(*seconds_of_job[i]);
    same_sequence[plan.jobs[i].sequence].Add(*seconds_of_job[i]);
    all.Add(*seconds_of_job[i]);
  }
  if (all.count == 0) return std::nullopt;
  double left = 0;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (seconds_of_job[i]) continue;
    const Job& job = plan.jobs[i];
    Mean mean = same[{job.sequence, job.variant}];
    if (mean.count == 0) mean = same_sequence[job.sequence];
    if (mean.count == 0) mean = all;
    left += mean.sum / mean.count;
  }
  return left;
}

}  // namespace plumbline
