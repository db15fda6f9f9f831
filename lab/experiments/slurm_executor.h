// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_executor.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

struct SlurmOptions {
  // For scripts and notes of submitted tasks; on a file system shared by all nodes, as are program,
  // data and folders of tasks.
  std::filesystem::path folder;
  std::vector<std::string> sbatch;  // further arguments of sbatch: "--partition=long"
};

// Executes on a cluster with Slurm: tasks added between two calls of Submit are queued as job
// arrays, up to 1000 tasks each, exclusive ones in arrays of their own with --exclusive. A task has
// two processors (--cpus-per-task) and its limit of memory (--mem), and is not requeued by Slurm
// itself: the caller retries.
//
// Each task leaves its exit code in its folder (end.txt), where Poll finds it; Slurm is queried
// only for tasks without one. Submissions are noted in `folder` before, so that an executor made
// after its predecessor was killed finds the tasks again, by folder and key, whether they wait, run
// or have ended, and does not submit them again; a task of another key that still runs in the same
// folder is cancelled first. The destructor does not change the queue.
class SlurmExecutor : public JobExecutor {
 public:
  // Throws InputError if the folder cannot be used or a note in it cannot be read.
  explicit SlurmExecutor(SlurmOptions options);

  bool HasRoom(const JobTask&) const override { return true; }
  // Throws InputError if Slurm cannot be queried.
  void Add(std::size_t id, const JobTask& task) override;
  // Throws InputError with the message of sbatch if it refuses.
  void Submit() override;
  std::vector<Ended> Poll() override;
  std::size_t Running() const override;
  std::chrono::milliseconds PollEvery() const override { return std::chrono::milliseconds(500); }
  std::string WhatGoesOn() const override;

 private:
  using Clock = std::chrono::steady_clock;
  // Identifies a task by name of its batch and index in it.
  using Place = std::pair<std::string, int>;
  struct State {
    std::string name;  // "RUNNING"
    std::string node;
  };
  struct Record {
    std::filesystem::path folder;
    std::string key;
  };
  struct Batch {
    std::vector<Record> tasks;
  };
  struct Open {
    std::size_t id = 0;
    JobTask task;
    Place place;
    std::optional<Clock::time_point> gone;  // time since which Slurm reports its end
  };

  void ReadNotes();
  void SubmitBatch(const std::vector<std::pair<std::size_t, JobTask>>& tasks);
  void AskForStates();
  std::optional<Place> FindEarlier(const JobTask& task);
  void Cancel(const Place& place);
  std::optional<TaskEnd> EndOf(Open& open);
  TaskEnd WhatBecameOf(const Open& open) const;

  SlurmOptions options_;
  std::map<std::string, Batch> batches_;  // by name
  std::map<Place, State> states_;         // as of the last query
  std::optional<Clock::time_point> asked_, answered_;
  std::vector<std::pair<std::size_t, JobTask>> added_;
  std::vector<Open> open_;
};

// The script of a job array: each task runs its program and leaves "<batch> <index> <exit code>
// <seconds>" in end.txt of its folder.
std::string SlurmScript(const std::string& batch, const std::vector<JobTask>& tasks);

}  // namespace plumbline
