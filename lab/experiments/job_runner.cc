// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/job_runner.h"

#include "lab/experiments/consistency_figures.h"
#include "lab/experiments/line_map_figures.h"
#include "lab/experiments/pair_figures.h"
#include "lab/experiments/reversed_sequence.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/folder_lock.h"
#include "worlds/sequence_cache.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kShowEvery(500);

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
  std::ifstream log(LogOf(job.folder));
  std::string last, line;
  while (std::getline(log, line)) {
    if (!line.empty()) last = line;
  }
  const std::string prefix = "plumbline: ";
  if (last.starts_with(prefix)) last.erase(0, prefix.size());
  // Results contain no paths.
  ReplaceAll(last, plan.SequenceOf(job).path.string(), plan.SequenceOf(job).name);
  ReplaceAll(last, plan.out.string(), "OUT");
  return last;
}

// Returns true if words are the output of a program with too little memory, of which there are
// several kinds: threads need memory, and so do its libraries.
bool SaysThatMemoryRanOut(const std::string& words) {
  return words == "no further thread can be started" ||
         words.find("failed to map segment") != std::string::npos;
}

std::string WhyFailed(const Plan& plan,
                      const Job& job,
                      const TaskEnd& end,
                      std::optional<int> memory_mb) {
  if (!end.trouble.empty()) return end.trouble;
  if (end.signal)
    return fmt::format("ended by signal {} ({})", *end.signal, sigdescr_np(*end.signal));
  const std::string words = LastWords(plan, job);
  if (end.code != 0 && (words == "out of memory" || (memory_mb && SaysThatMemoryRanOut(words)))) {
    return OutOfMemory(memory_mb);
  }
  if (end.code != 0) return words.empty() ? fmt::format("exit code {}", end.code) : words;
  return job.computed ? "no results.json" : "no summary.json";
}

// Returns true if a program ended well, or found no pose in the whole sequence, which is a result.
bool HasResult(const Plan& plan, const Job& job, const TaskEnd& end) {
  if (!end.trouble.empty() || end.signal) return false;
  return end.code == 0 ||
         (end.code == 1 && LastWords(plan, job).starts_with("no frame has a pose"));
}

// Returns true if a retry may succeed.
bool IsWorthAnotherTry(const TaskEnd& end) {
  constexpr int kBadInput = 2;
  if (!end.trouble.empty()) return end.by_machine;
  return end.signal.has_value() || (end.code != 0 && end.code != kBadInput);
}

class Runner {
 public:
  Runner(const std::vector<const Plan*>& plans,
         JobExecutor& executor,
         const RunnerOptions& options,
         const PlanFinished& finished)
      : plans_(plans), executor_(executor), options_(options), finished_(finished) {
    for (std::size_t p = 0; p < plans.size(); ++p) {
      results_.emplace_back(plans[p]->jobs.size());
      seconds_.emplace_back(plans[p]->jobs.size());
      open_.push_back(plans[p]->jobs.size());
      state_.total += plans[p]->jobs.size();
    }
  }

  std::optional<std::vector<std::vector<JobResult>>> Run() {
    FindWhatIsDone();
    try {
      RenderWorlds();
      WriteReversedSequences();
    } catch (const Stopped&) {
      return std::nullopt;
    }
    while (!waiting_.empty() || !running_.empty()) {
      StartWhatFits();
      if (IsToStop()) return std::nullopt;
      std::this_thread::sleep_for(executor_.PollEvery());
      for (const JobExecutor::Ended& ended : executor_.Poll()) TakeIn(ended.id, ended.end);
      Show();
    }
    shown_ = {};
    Show();
    return std::move(results_);
  }

 private:
  struct Item {
    std::size_t plan = 0, job = 0;
  };

  const Plan& PlanOf(const Item& item) const { return *plans_[item.plan]; }
  const Job& JobOf(const Item& item) const { return PlanOf(item).jobs[item.job]; }
  bool IsToStop() const { return options_.stop && options_.stop(); }

  // Not more often than somebody can read, and when something has changed.
  void Show() {
    if (!options_.progress) return;
    const auto now = Clock::now();
    if (!changed_ && now - shown_ < kShowEvery) return;
    shown_ = now;
    changed_ = false;
    state_.running = executor_.Running();
    if (!running_.empty()) {
      const Item& first = running_.begin()->second;
      state_.current = PlanOf(first).NameOf(JobOf(first));
    }
    state_.seconds_left = 0;
    for (std::size_t p = 0; p < plans_.size(); ++p) {
      if (open_[p] > 0) state_.seconds_left += SecondsLeft(*plans_[p], seconds_[p]);
    }
    if (state_.running > 1) state_.seconds_left /= static_cast<double>(state_.running);
    options_.progress(state_);
  }

  void FindWhatIsDone() {
    for (std::size_t p = 0; p < plans_.size(); ++p) {
      for (std::size_t j = 0; j < plans_[p]->jobs.size(); ++j) {
        const Job& job = plans_[p]->jobs[j];
        const bool done = !options_.force && IsDone(job);
        if (done) {
          Keep({p, j}, *ReadResult(job));
        } else {
          waiting_.push_back({p, j});
        }
      }
      if (open_[p] == 0) Finish(p);
    }
    const auto timed =
        std::stable_partition(waiting_.begin(), waiting_.end(), [this](const Item& item) {
          return !PlanOf(item).experiment.exclusive;
        });
    // The variants of a sequence take turns.
    std::stable_sort(timed, waiting_.end(), [this](const Item& a, const Item& b) {
      return std::tuple(a.plan, JobOf(a).sequence, JobOf(a).run) <
             std::tuple(b.plan, JobOf(b).sequence, JobOf(b).run);
    });
  }

  void Finish(std::size_t plan) {
    if (finished_) finished_(plan, results_[plan]);
  }

  void Keep(const Item& item, RunFigures figures) {
    const Plan& plan = PlanOf(item);
    const Job& job = JobOf(item);
    ++state_.done;
    --open_[item.plan];
    changed_ = true;
    if (!job.computed) {
      AddLineMapFigures(plan.SequenceOf(job).path, job.folder, figures);
      const auto& metrics = plan.experiment.metrics;
      const auto asked = [&](const char* name) {
        return std::find(metrics.begin(), metrics.end(), name) != metrics.end();
      };
      if (AsksForMapLines(metrics)) {
        AddMapLineFigures(job.command.at(1), job.folder, figures);
      }
      if (AsksForConsistency(metrics)) {
        AddConsistencyFigures(job.command.at(1), job.folder, figures);
      }
      if (asked("rpe_pairs") || asked("start_rpe")) {
        AddPairFigures(job.command.at(1), job.folder, figures);
      }
      if (asked("start_frames")) AddStartFigure(job.folder, figures);
    }
    const auto wall = figures.values.find("wall_s");
    if (wall != figures.values.end()) seconds_[item.plan][item.job] = wall->second;
    results_[item.plan][item.job].figures = std::move(figures);
  }

  void WriteReversedSequences() {
    for (const Item& item : waiting_) {
      const Job& job = JobOf(item);
      if (job.reversed.empty() || IsToStop()) continue;
      WriteReversedSequence(PlanOf(item).SequenceOf(job).path, job.reversed);
    }
  }

  void RenderWorlds() {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (const Item& item : waiting_) {
      const ExperimentSequence& sequence = PlanOf(item).SequenceOf(JobOf(item));
      if (!sequence.rendered) continue;
      const SynthOptions& options = sequence.rendered->options;
      CachedSequence(PlanOf(item).cache, sequence.rendered->world, options, threads, [&](int done) {
        if (IsToStop()) throw Stopped();
        state_.current = fmt::format("rendering {}: {} frames", sequence.name, done);
        changed_ = changed_ || shown_ == Clock::time_point{};
        Show();
      });
    }
  }

  double LimitOf(const Item& item) const {
    constexpr double kStart = 60, kFramesOfUnknown = 3600;
    // A frame is offered to all starts of the six seconds before it.
    const auto command = PlanOf(item).experiment.command;
    const double per_frame = command == RunCommandKind::kStarts ? 6 : 1;
    const std::size_t frames = PlanOf(item).SequenceOf(JobOf(item)).frames;
    return options_.time_limit_s.value_or(
        kStart + per_frame * (frames > 0 ? static_cast<double>(frames) : kFramesOfUnknown));
  }

  JobTask TaskOf(const Item& item) const {
    const Job& job = JobOf(item);
    JobTask task;
    const bool by_earlier = PlanOf(item).VariantOf(job).by_earlier;
    task.command = {(by_earlier ? options_.earlier : options_.program).string()};
    task.command.insert(task.command.end(), job.command.begin(), job.command.end());
    task.folder = job.folder;
    task.name = PlanOf(item).NameOf(job);
    task.key = job.key;
    task.limit_s = LimitOf(item);
    task.memory_mb = options_.memory_mb;
    task.exclusive = PlanOf(item).experiment.exclusive;
    return task;
  }

  void StartWhatFits() {
    bool added = false;
    while (!waiting_.empty()) {
      const Item item = waiting_.front();
      const JobTask task = TaskOf(item);
      if (!executor_.HasRoom(task)) break;
      waiting_.pop_front();
      MakeFolder(task.folder);
      MarkUndone(JobOf(item));
      executor_.Add(next_id_, task);
      running_[next_id_++] = item;
      added = changed_ = true;
    }
    if (!added) return;
    executor_.Submit();
    Show();
  }

  void TakeIn(std::size_t id, const TaskEnd& end) {
    const Item item = running_.at(id);
    running_.erase(id);
    const Job& job = JobOf(item);
    auto figures = HasResult(PlanOf(item), job, end) ? ReadResult(job) : std::nullopt;
    JobResult& result = results_[item.plan][item.job];
    if (figures) {
      MarkDone(job);
      Keep(item, *std::move(figures));
    } else {
      const std::string reason = WhyFailed(PlanOf(item), job, end, options_.memory_mb);
      if (result.earlier.size() < static_cast<std::size_t>(options_.retries) &&
          IsWorthAnotherTry(end) && reason != OutOfMemory(options_.memory_mb)) {
        result.earlier.push_back(reason);
        waiting_.push_back(item);
        return;
      }
      result.reason = reason;
      ++state_.done;
      ++state_.failed;
      --open_[item.plan];
      changed_ = true;
    }
    seconds_[item.plan][item.job] = end.seconds;
    if (open_[item.plan] == 0) Finish(item.plan);
  }

  const std::vector<const Plan*>& plans_;
  JobExecutor& executor_;
  const RunnerOptions& options_;
  const PlanFinished& finished_;
  RunnerState state_;
  // The result of each job: the outer index is the plan, the inner one the job in it.
  std::vector<std::vector<JobResult>> results_;
  std::vector<std::vector<std::optional<double>>> seconds_;  // of the jobs that have ended
  std::vector<std::size_t> open_;                            // jobs of a plan without a result
  std::deque<Item> waiting_;
  std::map<std::size_t, Item> running_;  // by number of the task
  std::size_t next_id_ = 0;
  Clock::time_point shown_;
  bool changed_ = false;
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

std::optional<std::vector<std::vector<JobResult>>> RunPlans(const std::vector<const Plan*>& plans,
                                                            const std::filesystem::path& folder,
                                                            JobExecutor& executor,
                                                            const RunnerOptions& options,
                                                            const PlanFinished& finished) {
  MakeFolder(folder);
  const FolderLock lock(folder, "another experiment is running in this folder");
  return Runner(plans, executor, options, finished).Run();
}

std::optional<std::vector<JobResult>> RunJobs(const Plan& plan,
                                              JobExecutor& executor,
                                              const RunnerOptions& options) {
  auto results = RunPlans({&plan}, plan.out, executor, options);
  if (!results) return std::nullopt;
  return std::move(results->front());
}

double SecondsLeft(const Plan& plan, const std::vector<std::optional<double>>& seconds_of_job) {
  std::map<std::pair<std::size_t, std::size_t>, Mean> same;
  double measured = 0, estimated = 0;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (!seconds_of_job[i]) continue;
    same[{plan.jobs[i].sequence, plan.jobs[i].variant}].Add(*seconds_of_job[i]);
    measured += *seconds_of_job[i];
    estimated += EstimatedSeconds(plan, plan.jobs[i]);
  }
  const double factor = estimated > 0 ? measured / estimated : 1;
  double left = 0;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (seconds_of_job[i]) continue;
    const Job& job = plan.jobs[i];
    const auto mean = same.find({job.sequence, job.variant});
    left += mean != same.end() ? mean->second.sum / mean->second.count
                               : factor * EstimatedSeconds(plan, job);
  }
  return left;
}

}  // namespace plumbline
