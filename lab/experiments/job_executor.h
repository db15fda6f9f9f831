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

// A program to run for a job.
struct JobTask {
  std::vector<std::string> command;  // program and arguments
  std::filesystem::path folder;      // existing folder; its log.txt gets the output of the program
  std::string name;                  // for display
  std::string key;                   // Job::key
  double limit_s = 0;                // longer tasks are killed
  std::optional<int> memory_mb;      // memory limit; nullopt: none
  bool exclusive = false;            // true: nothing else runs concurrently
};

// End of a task.
struct TaskEnd {
  int code = 0;
  std::optional<int> signal;
  std::string trouble;      // reason of an abnormal end: "no end after 60 s"
  bool by_machine = false;  // true if the machine is at fault: a retry elsewhere may succeed
  double seconds = 0;
};

// Executes the programs of jobs: on this machine, or on those of a cluster. Tasks are identified by
// numbers of the caller.
class JobExecutor {
 public:
  JobExecutor() = default;
  JobExecutor(const JobExecutor&) = delete;
  JobExecutor& operator=(const JobExecutor&) = delete;
  virtual ~JobExecutor() = default;

  // Returns true if a task of this kind may be added now.
  virtual bool HasRoom(const JobTask& task) const = 0;
  virtual void Add(std::size_t id, const JobTask& task) = 0;
  // Called after a number of Add: starts the added tasks.
  virtual void Submit() = 0;
  struct Ended {
    std::size_t id = 0;
    TaskEnd end;
  };
  // Returns the tasks that have ended since the last call. Does not wait.
  virtual std::vector<Ended> Poll() = 0;
  // Returns the number of running tasks, as far as known.
  virtual std::size_t Running() const = 0;
  // Returns the time to wait between two calls of Poll.
  virtual std::chrono::milliseconds PollEvery() const = 0;
  // Returns a description of the tasks that continue if the caller is interrupted; empty: none.
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

// Runs up to a given number of tasks at once on this machine; an exclusive one alone. The
// destructor kills running tasks.
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
