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
  // For scripts and notes of what was submitted; on a file system that all nodes share, as are
  // program, data and folders of tasks.
  std::filesystem::path folder;
  std::vector<std::string> sbatch;  // further arguments of sbatch: "--partition=long"
};

// On a cluster with Slurm: what was added between two calls of Submit goes to the queue as job
// arrays, up to 1000 tasks each, exclusive ones in arrays of their own with --exclusive. A task
// runs with two processors (--cpus-per-task) and the memory it may have (--mem), and is not
// requeued by Slurm itself: who called tries again.
//
// Each task leaves its exit code in its folder (end.txt), where Poll finds it; Slurm is asked only
// what became of those that leave none. What is submitted is noted in `folder` before, so that an
// executor that is made after the collector was killed finds the tasks again, by folder and key,
// whether they wait, run or have ended, and does not submit them anew; one of another key that
// still runs in the folder of a task is cancelled first. Destroyed, it leaves the queue alone.
class SlurmExecutor : public JobExecutor {
 public:
  // Throws InputError where the folder cannot be used or a note in it not be read.
  explicit SlurmExecutor(SlurmOptions options);

  bool HasRoom(const JobTask&) const override { return true; }
  // Throws InputError when Slurm cannot be asked.
  void Add(std::size_t id, const JobTask& task) override;
  // Throws InputError with what sbatch says when it refuses.
  void Submit() override;
  std::vector<Ended> Poll() override;
  std::size_t Running() const override;
  std::chrono::milliseconds PollEvery() const override { return std::chrono::milliseconds(500); }
  std::string WhatGoesOn() const override;

 private:
  using Clock = std::chrono::steady_clock;
  // What is known of a task by name of its batch and index in it.
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
    std::optional<Clock::time_point> gone;  // since when Slurm says that it has ended
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
  std::map<Place, State> states_;         // as of the last question
  std::optional<Clock::time_point> asked_, answered_;
  std::vector<std::pair<std::size_t, JobTask>> added_;
  std::vector<Open> open_;
};

// The script of a job array: each task runs its program and leaves "<batch> <index> <exit code>
// <seconds>" in end.txt of its folder.
std::string SlurmScript(const std::string& batch, const std::vector<JobTask>& tasks);

}  // namespace plumbline
