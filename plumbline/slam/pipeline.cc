// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/pipeline.h"

#include <algorithm>
#include <utility>

namespace plumbline {

Pipeline::Pipeline(System& system, Observer observer)
    : system_(system), observer_(std::move(observer)), mode_(system.options().slam.mode) {
  if (mode_ != RunMode::kInline) worker_ = std::jthread([this] { WorkUntilStopped(); });
}

Pipeline::~Pipeline() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  job_added_.notify_all();
}

void Pipeline::Feed(SensorFrame frame) {
  Job job;
  job.stamp_ns = frame.stamp_ns;
  if (mode_ == RunMode::kLive) {
    job.raw = std::move(frame);
  } else {
    job.measured = system_.Measure(std::move(frame));
  }
  Hand(std::move(job));
}

void Pipeline::Skip(std::int64_t stamp_ns, const std::string& reason) {
  Job job;
  job.stamp_ns = stamp_ns;
  job.reason = reason;
  Hand(std::move(job));
}

void Pipeline::Drain() {
  if (mode_ == RunMode::kInline) return;
  std::unique_lock lock(mutex_);
  job_taken_.wait(lock, [&] { return failure_ || (jobs_.empty() && !busy_); });
}

void Pipeline::Finish(const StopCheck& stop) {
  Drain();
  system_.Finish(stop);
  RethrowFailure();
}

void Pipeline::Hand(Job job) {
  if (mode_ == RunMode::kInline) {
    Do(std::move(job));
    return;
  }
  std::unique_lock lock(mutex_);
  if (mode_ == RunMode::kLockstep) {
    job_taken_.wait(lock, [&] { return failure_ || Waiting() < kMaxWaiting; });
  } else if (job.HasFrame() && Waiting() == kMaxWaiting) {
    DropOldest();
  }
  RethrowFailure();
  jobs_.push_back(std::move(job));
  job_added_.notify_one();
}

// Its place in the order of frames stays.
void Pipeline::DropOldest() {
  const auto oldest =
      std::find_if(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.HasFrame(); });
  oldest->raw.reset();
  oldest->reason = kDropped;
}

// Frames that somebody will have to work on.
std::size_t Pipeline::Waiting() const {
  return static_cast<std::size_t>(
      std::count_if(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.HasFrame(); }));
}

void Pipeline::Do(Job job) {
  if (!job.HasFrame()) {
    observer_(system_.Skip(job.stamp_ns, job.reason), FrameView{});
    return;
  }
  if (job.raw) {
    job.clock.Done("wait");
    job.measured = system_.Measure(std::move(*job.raw), std::move(job.clock));
  }
  const FrameRecord& record = system_.Track(std::move(*job.measured));
  observer_(record, system_.view());
}

void Pipeline::WorkUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    job_added_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr failure;
    try {
      Do(std::move(job));
    } catch (...) {  // rethrown in the feeding thread
      failure = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    failure_ = failure;
    job_taken_.notify_all();
    if (failure_) return;
  }
}

void Pipeline::RethrowFailure() {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace plumbline
