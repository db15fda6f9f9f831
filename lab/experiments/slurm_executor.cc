// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/slurm_executor.h"

#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <set>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostTasks = 1000;  // of an array: Slurm's own default allows one more
constexpr std::chrono::seconds kAskEvery(2), kCommandLimit(60);
// For a file to be seen that another machine has written.
constexpr std::chrono::seconds kFileSystemDelay(5);
const std::string kEnd = "end.txt";

struct CommandOutput {
  int code = 0;
  std::string text;
};

// Runs a program of Slurm and waits for it.
CommandOutput RunCommand(const std::vector<std::string>& words, const fs::path& folder) {
  std::vector<std::string> command = {"/usr/bin/env"};
  command.insert(command.end(), words.begin(), words.end());
  const fs::path log = folder / fmt::format("said-{}.txt", ::getpid());
  CommandOutput output;
  {
    ChildProcess process(command, log);
    const auto start = Clock::now();
    auto end = process.Poll();
    while (!end && Clock::now() - start < kCommandLimit) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      end = process.Poll();
    }
    output.code = end && !end->signal ? end->code : 1;
    if (!end) output.text = words[0] + " does not come to an end";
  }
  std::ifstream file(log);
  std::stringstream text;
  text << file.rdbuf();
  output.text += text.str();
  std::error_code error;
  fs::remove(log, error);
  constexpr int kNotFound = 127;
  if (output.code == kNotFound) {
    throw InputError(fmt::format("--executor slurm: {} cannot be started", words[0]));
  }
  return output;
}

std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

bool IsAlive(std::string_view state) {
  constexpr std::array kAlive = {
      "PENDING", "RUNNING", "CONFIGURING", "COMPLETING", "SUSPENDED", "REQUEUED", "RESIZING"};
  return std::find(kAlive.begin(), kAlive.end(), state) != kAlive.end();
}

// Result left by a task: exit code and seconds; nullopt if there is none, or that of another task.
std::optional<TaskEnd> ReadEnd(const fs::path& folder, const std::string& batch, int index) {
  std::ifstream file(folder / kEnd);
  std::string its_batch;
  int its_index = -1, code = 0;
  double seconds = 0;
  if (!(file >> its_batch >> its_index >> code >> seconds)) return std::nullopt;
  if (its_batch != batch || its_index != index) return std::nullopt;
  constexpr int kSignals = 128, kMostSignals = 64;  // of a shell's exit codes
  TaskEnd end;
  end.seconds = seconds;
  if (code > kSignals && code <= kSignals + kMostSignals) {
    end.signal = code - kSignals;
  } else {
    end.code = code;
  }
  return end;
}

// A name that no other collector and no other moment has.
std::string NewBatchName(const fs::path& folder) {
  const std::string where = fs::absolute(folder).string();
  const auto place =
      Crc32(std::span(reinterpret_cast<const std::uint8_t*>(where.data()), where.size()));
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("plumbline-{:08x}-{:x}",
                     place,
                     std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

std::string SlurmScript(const std::string& batch, const std::vector<JobTask>& tasks) {
  std::string script =
      "#!/bin/bash\n# Made by plumbline experiment: one program for each index of a job array.\n"
      "case $SLURM_ARRAY_TASK_ID in\n";
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::vector<std::string> words;
    for (const std::string& word : tasks[i].command) words.push_back(Quoted(word));
    script +=
        fmt::format("{}) folder={} limit={:.0f} memory={}; set -- {} ;;\n",
                    i,
                    Quoted(tasks[i].folder.string()),
                    tasks[i].limit_s,
                    tasks[i].memory_mb ? std::to_string(*tasks[i].memory_mb * 1024) : "unlimited",
                    fmt::join(words, " "));
  }
  script += fmt::format(
      "esac\n"
      "(ulimit -v \"$memory\"; exec timeout -s KILL \"$limit\" \"$@\") "
      "> \"$folder/{1}\" 2>&1 < /dev/null\n"
      "code=$?\n"
      "echo \"{0} $SLURM_ARRAY_TASK_ID $code $SECONDS\" > \"$folder/{2}.$SLURM_ARRAY_TASK_ID\"\n"
      "mv \"$folder/{2}.$SLURM_ARRAY_TASK_ID\" \"$folder/{2}\"\n"
      "exit $code\n",
      batch,
      LogOf("").string(),
      kEnd);
  return script;
}

SlurmExecutor::SlurmExecutor(SlurmOptions options) : options_(std::move(options)) {
  MakeFolder(options_.folder);
  ReadNotes();
  if (!batches_.empty()) AskForStates();
}

void SlurmExecutor::ReadNotes() {
  for (const auto& entry : fs::directory_iterator(options_.folder)) {
    if (entry.path().extension() != ".json") continue;
    const auto note = nlohmann::json::parse(ReadInputFile(entry.path()), nullptr, false);
    const bool whole = note.is_array() && std::all_of(note.begin(), note.end(), [](const auto& t) {
                         return t.is_object() && t.contains("folder") && t.contains("key") &&
                                t["folder"].is_string() && t["key"].is_string();
                       });
    if (!whole) {
      throw InputError(entry.path().string() + ": expected a list of submitted tasks");
    }
    Batch& batch = batches_[entry.path().stem().string()];
    for (const auto& task : note) {
      batch.tasks.push_back(
          {task["folder"].template get<std::string>(), task["key"].template get<std::string>()});
    }
  }
}

void SlurmExecutor::AskForStates() {
  std::vector<std::string> names;
  for (const auto& [name, batch] : batches_) names.push_back(name);
  const CommandOutput said = RunCommand({"squeue",
                                         "--noheader",
                                         "--array",
                                         "--states=all",
                                         fmt::format("--name={}", fmt::join(names, ",")),
                                         "--format=%j|%K|%T|%N"},
                                        options_.folder);
  asked_ = Clock::now();
  if (said.code != 0) return;  // the controller is busy or away; it will be asked again
  answered_ = asked_;
  states_.clear();
  std::istringstream lines(said.text);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string name, index, state, node;
    if (!std::getline(fields, name, '|') || !std::getline(fields, index, '|') ||
        !std::getline(fields, state, '|')) {
      continue;
    }
    std::getline(fields, node);
    if (index.empty() || index.find_first_not_of("0123456789") != std::string::npos) continue;
    states_[{name, std::stoi(index)}] = {state, node};
  }
}

std::optional<SlurmExecutor::Place> SlurmExecutor::FindEarlier(const JobTask& task) {
  std::optional<Place> found;
  for (const auto& [name, batch] : batches_) {
    for (std::size_t i = 0; i < batch.tasks.size(); ++i) {
      if (batch.tasks[i].folder != task.folder) continue;
      const Place place(name, static_cast<int>(i));
      const auto state = states_.find(place);
      const bool alive = state != states_.end() && IsAlive(state->second.name);
      if (batch.tasks[i].key != task.key) {
        if (alive) Cancel(place);
      } else if (alive || ReadEnd(task.folder, name, place.second)) {
        found = place;
      }
    }
  }
  return found;
}

void SlurmExecutor::Cancel(const Place& place) {
  const auto is_alive = [&] {
    const auto state = states_.find(place);
    return state != states_.end() && IsAlive(state->second.name);
  };
  const CommandOutput said =
      RunCommand({"squeue", "--noheader", "--array", "--name=" + place.first, "--format=%F_%K"},
                 options_.folder);
  std::istringstream tasks(said.text);
  std::string task;
  while (std::getline(tasks, task)) {
    if (task.ends_with("_" + std::to_string(place.second))) {
      RunCommand({"scancel", task}, options_.folder);
    }
  }
  const auto start = Clock::now();
  while (is_alive() && Clock::now() - start < kCommandLimit) {
    std::this_thread::sleep_for(PollEvery());
    AskForStates();
  }
}

void SlurmExecutor::Add(std::size_t id, const JobTask& task) {
  if (const auto place = FindEarlier(task)) {
    open_.push_back({id, task, *place, std::nullopt});
  } else {
    added_.emplace_back(id, task);
  }
}

void SlurmExecutor::Submit() {
  // Arrays of tasks that ask for the same.
  std::map<std::pair<bool, int>, std::vector<std::pair<std::size_t, JobTask>>> alike;
  for (auto& [id, task] : added_) {
    auto& tasks = alike[{task.exclusive, task.memory_mb.value_or(0)}];
    tasks.emplace_back(id, std::move(task));
    if (tasks.size() < kMostTasks) continue;
    SubmitBatch(tasks);
    tasks.clear();
  }
  added_.clear();
  for (const auto& [kind, tasks] : alike) {
    if (!tasks.empty()) SubmitBatch(tasks);
  }
}

void SlurmExecutor::SubmitBatch(const std::vector<std::pair<std::size_t, JobTask>>& tasks) {
  const std::string name = NewBatchName(options_.folder);
  std::vector<JobTask> programs;
  nlohmann::json note = nlohmann::json::array();
  double limit = 0;
  Batch& batch = batches_[name];
  for (const auto& [id, task] : tasks) {
    programs.push_back(task);
    limit = std::max(limit, task.limit_s);
    batch.tasks.push_back({task.folder, task.key});
    note.push_back({{"folder", task.folder.string()}, {"key", task.key}});
    open_.push_back({id, task, {name, static_cast<int>(batch.tasks.size()) - 1}, std::nullopt});
  }
  const fs::path script = options_.folder / (name + ".sh");
  WriteFileAtomically(script, SlurmScript(name, programs));
  WriteFileAtomically(options_.folder / (name + ".json"), note.dump());
  constexpr double kMinute = 60;
  std::vector<std::string> command = {"sbatch",
                                      "--parsable",
                                      "--no-requeue",
                                      "--job-name=" + name,
                                      fmt::format("--array=0-{}", tasks.size() - 1),
                                      fmt::format("--time={:.0f}", limit / kMinute + 2),
                                      "--output=/dev/null",
                                      "--cpus-per-task=2"};
  if (programs[0].exclusive) command.emplace_back("--exclusive");
  if (programs[0].memory_mb) command.push_back(fmt::format("--mem={}", *programs[0].memory_mb));
  command.insert(command.end(), options_.sbatch.begin(), options_.sbatch.end());
  command.push_back(script.string());
  const CommandOutput said = RunCommand(command, options_.folder);
  if (said.code == 0) return;
  std::error_code error;
  fs::remove(options_.folder / (name + ".json"), error);
  throw InputError("sbatch: " + said.text.substr(0, said.text.find('\n')));
}

TaskEnd SlurmExecutor::WhatBecameOf(const Open& open) const {
  TaskEnd end;
  const auto found = states_.find(open.place);
  const std::string state = found == states_.end() ? "" : found->second.name;
  const std::string node = found == states_.end() ? "" : found->second.node;
  if (state == "OUT_OF_MEMORY") {
    end.trouble = OutOfMemory(open.task.memory_mb);
  } else if (state == "TIMEOUT" || state == "DEADLINE") {
    end.trouble = NoEndAfter(open.task.limit_s);
  } else if (state == "CANCELLED") {
    end.trouble = "cancelled in the queue";
  } else if (state == "NODE_FAIL" || state == "BOOT_FAIL" || state == "PREEMPTED") {
    end.trouble = fmt::format("its node {} went away ({})", node.empty() ? "?" : node, state);
    end.by_machine = true;
  } else {
    end.trouble = state.empty() ? "gone from the queue without an end"
                                : fmt::format("killed on its node ({})", state);
    end.by_machine = true;
  }
  return end;
}

std::optional<TaskEnd> SlurmExecutor::EndOf(Open& open) {
  if (auto end = ReadEnd(open.task.folder, open.place.first, open.place.second)) {
    constexpr int kKill = 9;
    if (end->signal == kKill && end->seconds + 1 >= open.task.limit_s) {
      end->trouble = NoEndAfter(open.task.limit_s);
    }
    // Seen once: another call retries failed tasks.
    std::error_code error;
    fs::remove(open.task.folder / kEnd, error);
    return end;
  }
  const auto state = states_.find(open.place);
  if (state != states_.end() && IsAlive(state->second.name)) {
    open.gone = std::nullopt;
    return std::nullopt;
  }
  if (!open.gone) open.gone = Clock::now();
  // Slurm must have said so again, that much later.
  if (!answered_ || *answered_ < *open.gone + kFileSystemDelay) return std::nullopt;
  return WhatBecameOf(open);
}

std::vector<JobExecutor::Ended> SlurmExecutor::Poll() {
  if (!open_.empty() && (!asked_ || Clock::now() - *asked_ >= kAskEvery)) AskForStates();
  std::vector<Ended> ended;
  for (auto it = open_.begin(); it != open_.end();) {
    if (auto end = EndOf(*it)) {
      ended.push_back({it->id, *std::move(end)});
      it = open_.erase(it);
    } else {
      ++it;
    }
  }
  return ended;
}

std::size_t SlurmExecutor::Running() const {
  std::size_t running = 0;
  for (const Open& open : open_) {
    const auto state = states_.find(open.place);
    running += state != states_.end() && state->second.name == "RUNNING";
  }
  return running;
}

std::string SlurmExecutor::WhatGoesOn() const {
  std::set<std::string> names;
  for (const Open& open : open_) names.insert(open.place.first);
  if (names.empty()) return "";
  return fmt::format("what is submitted goes on in the queue (scancel --name={} ends it)",
                     fmt::join(names, ","));
}

}  // namespace plumbline
