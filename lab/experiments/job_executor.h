// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/child_process.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <list>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// A program to be run for a job.
struct JobTask {
  std::vector<std::string> command;  // program and arguments
  std::filesystem::path folder;      // is there; its log.txt gets what the program says
  std::string name;                  // for people
  std::string key;                   // Job::key
  double limit_s = 0;                // what takes longer is killed
  std::optional<int> memory_mb;      // the most it may have; nullopt: as much as there is
  bool exclusive = false;            // nothing else runs beside it
};

// How a task ended.
struct TaskEnd {
  int code = 0;
  std::optional<int> signal;
  std::string trouble;      // why it did not come to an end of its own: "no end after 60 s"
  bool by_machine = false;  // the trouble is the machine's: elsewhere it may go well
  double seconds = 0;
};

// Where the programs of jobs run: on this machine, or on those of a cluster. Tasks are told apart
// by numbers that the caller gives.
class JobExecutor {
 public:
  JobExecutor() = default;
  JobExecutor(const JobExecutor&) = delete;
  JobExecutor& operator=(const JobExecutor&) = delete;
  virtual ~JobExecutor() = default;

  // Whether a task of this kind may be added now.
  virtual bool HasRoom(const JobTask& task) const = 0;
  virtual void Add(std::size_t id, const JobTask& task) = 0;
  // Called after a number of Add: what was added is to start now.
  virtual void Submit() = 0;
  struct Ended {
    std::size_t id = 0;
    TaskEnd end;
  };
  // Those that have ended since the last call. Does not wait.
  virtual std::vector<Ended> Poll() = 0;
  // How many are running, as far as is known.
  virtual std::size_t Running() const = 0;
  // How long to wait between two calls of Poll.
  virtual std::chrono::milliseconds PollEvery() const = 0;
  // What remains when the caller goes away in the middle, for people; empty: nothing.
  virtual std::string WhatGoesOn() const = 0;
};

// The log of a task.
inline std::filesystem::path LogOf(const std::filesystem::path& folder) {
  return folder / "log.txt";
}

// "no end after 60 s"
std::string NoEndAfter(double limit_s);
// "out of memory (limit 100 MB)"; without a limit: "out of memory".
std::string OutOfMemory(std::optional<int> limit_mb);

// On this machine, so many at once; an exclusive one alone. Destroyed, it kills what still runs.
class LocalExecutor : public JobExecutor {
 public:
  explicit LocalExecutor(int jobs) : jobs_(static_cast<std::size_t>(jobs)) {}

  bool HasRoom(const JobTask& task) const override;
  void Add(std::size_t id, const JobTask& task) override;
  void Submit() override {}
  std::vector<Ended> Poll() override;
  std::size_t Running() const override { return running_.size(); }
  std::chrono::milliseconds PollEvery() const override { return std::chrono::milliseconds(10); }
  std::string WhatGoesOn() const override { return ""; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Process {
    Process(std::size_t number, const JobTask& its)
        : id(number), task(its), process(task.command, LogOf(task.folder), task.memory_mb) {}
    std::size_t id;
    JobTask task;
    ChildProcess process;
    Clock::time_point start = Clock::now();
  };
  std::size_t jobs_;
  std::list<Process> running_;
};

}  // namespace plumbline
