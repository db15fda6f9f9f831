// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/pipeline.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace plumbline {
namespace {

bool IsBlack(const GrayImage& mask) {
  const std::ptrdiff_t pixels = std::ptrdiff_t{mask.width()} * mask.height();
  return std::all_of(
      mask.data(), mask.data() + pixels, [](std::uint8_t level) { return level == 0; });
}

}  // namespace

Pipeline::Pipeline(System& system, Observer observer)
    : system_(system),
      observer_(std::move(observer)),
      mode_(system.options().slam.mode),
      execution_(system.execution()) {
  PLUMBLINE_CHECK(mode_ == RunMode::kLive || execution_.threads,
                  "only a live run is done step by step");
  if (mode_ != RunMode::kInline && execution_.threads)
    worker_ = std::jthread([this] { WorkUntilStopped(); });
}

Pipeline::~Pipeline() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  job_added_.notify_all();
}

void Pipeline::AddInertial(std::span<const InertialSample> samples) {
  inertial_.insert(inertial_.end(), samples.begin(), samples.end());
}

void Pipeline::Feed(SensorFrame frame) {
  if (frame.left_mask && IsBlack(*frame.left_mask)) {
    Skip(frame.stamp_ns, kBlackMask);
    return;
  }
  Job job;
  job.stamp_ns = frame.stamp_ns;
  if (mode_ == RunMode::kLive) {
    job.raw = std::move(frame);
    job.arrival = execution_.now();
    if (last_stamp_ns_) job.interval = 1e-9 * static_cast<double>(job.stamp_ns - *last_stamp_ns_);
    last_stamp_ns_ = job.stamp_ns;
  } else {
    job.extracted = system_.Extract(std::move(frame));
  }
  Hand(std::move(job));
}

void Pipeline::Skip(std::int64_t stamp_ns, const std::string& reason) {
  PLUMBLINE_CHECK(!reason.empty(), "a frame is left out for a reason");
  Job job;
  job.stamp_ns = stamp_ns;
  job.reason = reason;
  Hand(std::move(job));
}

void Pipeline::Drain() {
  if (mode_ == RunMode::kLive && !execution_.threads) {
    while (WorkOnce()) {
    }
  } else if (mode_ != RunMode::kInline) {
    std::unique_lock lock(mutex_);
    job_taken_.wait(lock, [&] { return failure_ || (jobs_.empty() && !busy_); });
  }
}

RunResult Pipeline::Finish(const StopCheck& stop, std::exception_ptr* failure) {
  Drain();
  std::exception_ptr first;
  RunResult result = system_.Finish(stop, &first);
  if (!first) first = failure_;
  if (failure != nullptr) *failure = first;
  if (failure == nullptr && first) std::rethrow_exception(first);
  return result;
}

void Pipeline::Hand(Job job) {
  job.inertial = std::exchange(inertial_, {});
  if (mode_ == RunMode::kInline) {
    Process(std::move(job));
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

// Gives up the oldest frame that waits. Its job stays in the queue, so that the order of frames
// stays.
void Pipeline::DropOldest() {
  const auto oldest =
      std::find_if(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.HasFrame(); });
  oldest->raw.reset();
  oldest->reason = kDropped;
  oldest->dropped = true;
}

// Returns how many frames wait that have images to work on.
std::size_t Pipeline::Waiting() const {
  return static_cast<std::size_t>(
      std::count_if(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.HasFrame(); }));
}

void Pipeline::Process(Job job) {
  system_.AddInertial(job.inertial);
  if (!job.HasFrame()) {
    dropped_ += job.dropped;
    observer_(system_.Skip(
                  job.stamp_ns, job.reason, job.dropped ? LoadLevel::kFrame : LoadLevel::kNothing),
              FrameView{});
    return;
  }
  if (job.raw) {
    job.clock.Done("wait");
    const LoadLevel shed = Decide(job);
    job.extracted = system_.Extract(std::move(*job.raw), std::move(job.clock), shed);
  }
  const FrameRecord& record = system_.Track(std::move(*job.extracted));
  observer_(record, system_.view());
  system_.Complete();
}

// Returns the level of shedding for the next frame.
LoadLevel Pipeline::Decide(const Job& job) {
  Load load;
  const std::chrono::duration<double> waited = execution_.now() - job.arrival;
  if (job.interval > 0) load.wait = waited.count() / job.interval;
  load.frames_dropped = std::exchange(dropped_, 0);
  load.tasks_waiting = static_cast<int>(system_.TasksWaiting());
  return shedding_.Next(load);
}

void Pipeline::WorkUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    job_added_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    ProcessNext(lock);
    if (failure_) return;
  }
}

bool Pipeline::WorkOnce() {
  std::unique_lock lock(mutex_);
  if (jobs_.empty() || failure_) return false;
  ProcessNext(lock);
  return true;
}

// Executes the next job; the lock is released meanwhile. Its exceptions are rethrown in the feeding
// thread.
void Pipeline::ProcessNext(std::unique_lock<std::mutex>& lock) {
  Job job = std::move(jobs_.front());
  jobs_.pop_front();
  busy_ = true;
  lock.unlock();
  std::exception_ptr failure;
  try {
    Process(std::move(job));
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  busy_ = false;
  failure_ = failure;
  job_taken_.notify_all();
}

void Pipeline::RethrowFailure() {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace plumbline
