// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/background_adjustment.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

// Lowers the priority of the calling thread, so that the program's other threads run first. If the
// operating system refuses, nothing changes.
void LowerPriority() {
  constexpr int kLowest = 19;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowest);
}

}  // namespace

BackgroundAdjustment::~BackgroundAdjustment() { GiveUp(); }

void BackgroundAdjustment::Begin(const Map& map, std::int64_t due_frame, Compute compute) {
  GiveUp();
  job_ = std::make_unique<Job>();
  job_->compute = std::move(compute);
  job_->map = map;
  job_->id = map.id();
  job_->due_frame = due_frame;
  if (worker_ == Worker::kCaller) return;
  job_->thread = std::jthread([low = worker_ == Worker::kThreadOfLowPriority, job = job_.get()] {
    if (low) LowerPriority();
    Run(*job);
  });
}

void BackgroundAdjustment::GiveUp() {
  Reap();
  if (job_ == nullptr) return;
  job_->stop = true;
  Park(std::move(job_));
}

// Keeps a job until its thread has ended.
void BackgroundAdjustment::Park(std::unique_ptr<Job> job) {
  if (job->thread.joinable()) parked_.push_back(std::move(job));
}

// Frees the jobs that were ready at the last call already. Their threads have had the time since
// then to end, so that joining them does not wait.
void BackgroundAdjustment::Reap() {
  std::erase_if(parked_, [](const std::unique_ptr<Job>& job) {
    return std::exchange(job->was_ready, job->ready.load());
  });
}

std::optional<BackgroundAdjustment::Result> BackgroundAdjustment::TakeDue(std::int64_t frame) {
  if (job_ == nullptr || frame < job_->due_frame) return std::nullopt;
  return Take();
}

std::optional<BackgroundAdjustment::Result> BackgroundAdjustment::TakeReady() {
  Reap();
  if (job_ == nullptr || !job_->ready) return std::nullopt;
  return Take();
}

std::optional<BackgroundAdjustment::Result> BackgroundAdjustment::TakeAtEnd(const StopCheck& stop) {
  constexpr auto kStep = std::chrono::milliseconds(5);
  if (job_ == nullptr) return std::nullopt;
  while (!job_->ready) {
    if (IsToStop(stop)) {
      GiveUp();
      return std::nullopt;
    }
    if (job_->thread.joinable()) {
      std::this_thread::sleep_for(kStep);
    } else {
      Run(*job_, stop);
    }
  }
  return Take();
}

void BackgroundAdjustment::Run(Job& job, const StopCheck& stop) {
  try {
    job.correction = job.compute(job.map, [&] { return job.stop.load() || IsToStop(stop); });
  } catch (...) {
    job.failure = std::current_exception();
  }
  // Freeing the unshared parts of the copy may take long, and the job may stay parked.
  job.map = Map();
  job.ready = true;
}

// Waits for the computation, which begins only now if it has no thread.
void BackgroundAdjustment::Complete() {
  if (job_->ready) return;
  if (job_->thread.joinable()) job_->thread.join();
  if (!job_->ready) Run(*job_);
}

BackgroundAdjustment::Result BackgroundAdjustment::Take() {
  Complete();
  const std::exception_ptr failure = job_->failure;
  Result result{job_->id, std::move(job_->correction)};
  Park(std::move(job_));
  if (failure) std::rethrow_exception(failure);
  return result;
}

std::int64_t AdjustmentDelay(const Map& map) {
  constexpr std::int64_t kAtLeast = 10;
  constexpr std::int64_t kKeyFramesPerFrame = 2;
  return kAtLeast + static_cast<std::int64_t>(map.keyframes().size()) / kKeyFramesPerFrame;
}

}  // namespace plumbline
