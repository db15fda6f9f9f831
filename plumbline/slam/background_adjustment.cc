// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/background_adjustment.h"

#include <exception>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

// Lowers the priority of the calling thread, so that the program's other threads run first. Where
// the operating system refuses, nothing changes.
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
  thread_ = std::jthread([low = worker_ == Worker::kThreadOfLowPriority, job = job_.get()] {
    if (low) LowerPriority();
    Run(*job);
  });
}

void BackgroundAdjustment::GiveUp() {
  if (job_ != nullptr) job_->stop = true;
  if (thread_.joinable()) thread_.join();
  job_.reset();
}

std::optional<BackgroundAdjustment::Result> BackgroundAdjustment::TakeDue(std::int64_t frame) {
  if (job_ == nullptr || frame < job_->due_frame) return std::nullopt;
  return Take();
}

std::optional<BackgroundAdjustment::Result> BackgroundAdjustment::TakeReady() {
  if (job_ == nullptr || !job_->ready) return std::nullopt;
  return Take();
}

void BackgroundAdjustment::Run(Job& job) {
  try {
    job.correction = job.compute(job.map, [&job] { return job.stop.load(); });
  } catch (...) {
    job.failure = std::current_exception();
  }
  job.ready = true;
}

void BackgroundAdjustment::Complete() {
  if (thread_.joinable()) thread_.join();
  if (!job_->ready) Run(*job_);
}

BackgroundAdjustment::Result BackgroundAdjustment::Take() {
  Complete();
  const std::unique_ptr<Job> job = std::move(job_);
  if (job->failure) std::rethrow_exception(job->failure);
  return {job->id, std::move(job->correction)};
}

std::optional<BackgroundAdjustment::Pending> BackgroundAdjustment::Save() {
  if (job_ == nullptr) return std::nullopt;
  Complete();
  if (job_->failure) std::rethrow_exception(job_->failure);
  return Pending{{job_->id, job_->correction}, job_->due_frame};
}

void BackgroundAdjustment::Resume(const std::optional<Pending>& pending) {
  GiveUp();
  if (!pending) return;
  job_ = std::make_unique<Job>();
  job_->id = pending->result.map;
  job_->due_frame = pending->due_frame;
  job_->correction = pending->result.correction;
  job_->ready = true;
}

std::int64_t AdjustmentDelay(const Map& map) {
  constexpr std::int64_t kAtLeast = 10;
  constexpr std::int64_t kKeyFramesPerFrame = 2;
  return kAtLeast + static_cast<std::int64_t>(map.keyframes().size()) / kKeyFramesPerFrame;
}

}  // namespace plumbline
