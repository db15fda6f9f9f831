// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/job_executor.h"

#include <fmt/format.h>

namespace plumbline {

std::string NoEndAfter(double limit_s) { return fmt::format("no end after {:.0f} s", limit_s); }

std::string OutOfMemory(std::optional<int> limit_mb) {
  return limit_mb ? fmt::format("out of memory (limit {} MB)", *limit_mb) : "out of memory";
}

bool LocalExecutor::HasRoom(const JobTask& task) const {
  if (running_.empty()) return true;
  if (task.exclusive || running_.front().task.exclusive) return false;
  return running_.size() < jobs_;
}

void LocalExecutor::Add(std::size_t id, const JobTask& task) { running_.emplace_back(id, task); }

std::vector<JobExecutor::Ended> LocalExecutor::Poll() {
  std::vector<Ended> ended;
  for (auto it = running_.begin(); it != running_.end();) {
    const double seconds = std::chrono::duration<double>(Clock::now() - it->start).count();
    const auto end = it->process.Poll();
    if (!end && seconds <= it->task.limit_s) {
      ++it;
      continue;
    }
    TaskEnd how;
    how.seconds = seconds;
    if (end) {
      how.code = end->code;
      how.signal = end->signal;
    } else {
      how.trouble = NoEndAfter(it->task.limit_s);
    }
    ended.push_back({it->id, how});
    it = running_.erase(it);  // kills it if it still runs
  }
  return ended;
}

}  // namespace plumbline
