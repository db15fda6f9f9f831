// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/map_correction.h"

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace plumbline {

// Computes one correction of a whole map beside mapping, from a copy of the map.
//
// The frame at which a correction takes effect is part of the algorithm: Begin sets it by the size
// of the problem, and TakeDue waits for the correction at that frame. Only a live run takes a
// correction as soon as it is ready. A correction that begins while another one is computed
// replaces it, because the older one does not include the reason for the newer one. The older
// thread is told to stop, but not waited for: on a busy machine a thread of low priority may take
// seconds to notice.
//
// All functions are for one thread. A failure of the computation is rethrown when the result is
// taken.
class BackgroundAdjustment {
 public:
  using Compute = std::function<MapCorrection(const Map& map, const StopCheck& stop)>;
  enum class Worker { kCaller, kThread, kThreadOfLowPriority };

  struct Result {
    MapId map;
    MapCorrection correction;
  };

  // With Worker::kCaller the correction is computed in the caller's thread when it is taken.
  explicit BackgroundAdjustment(Worker worker) : worker_(worker) {}
  // Cancels the running computation, and waits until all computations have stopped.
  ~BackgroundAdjustment();
  BackgroundAdjustment(const BackgroundAdjustment&) = delete;
  BackgroundAdjustment& operator=(const BackgroundAdjustment&) = delete;

  // Begins a correction of a copy of the map. Copying is cheap: map and copy share all unchanged
  // parts.
  void Begin(const Map& map, std::int64_t due_frame, Compute compute);
  // Tells the computation to stop, without waiting for it.
  void GiveUp();
  bool Running() const { return job_ != nullptr; }
  // The map of the running computation. Only while one is running.
  MapId map() const { return job_->id; }

  // Waits for the correction and returns it if `frame` has reached its due frame. Returns it only
  // once.
  std::optional<Result> TakeDue(std::int64_t frame);
  // Returns the correction if it is ready, and only once.
  std::optional<Result> TakeReady();
  // Waits for the correction, before its due frame too, and returns it. When stopped, one that is
  // not ready is given up.
  std::optional<Result> TakeAtEnd(const StopCheck& stop);

 private:
  struct Job {
    Compute compute;
    Map map;
    MapId id;
    std::int64_t due_frame = 0;
    MapCorrection correction;
    std::exception_ptr failure;
    std::atomic<bool> stop = false;
    std::atomic<bool> ready = false;
    bool was_ready = false;  // at the last call of Reap
    std::jthread thread;     // declared last: ends before the members it uses
  };
  static void Run(Job& job, const StopCheck& stop = {});
  void Park(std::unique_ptr<Job> job);
  void Reap();
  void Complete();
  Result Take();

  Worker worker_;
  std::unique_ptr<Job> job_;
  // Cancelled jobs whose threads may still run.
  std::vector<std::unique_ptr<Job>> parked_;
};

// Returns the number of frames after which the adjustment of a whole map takes effect in runs that
// do not depend on the speed of the machine: about twice its computing time, at 20 frames a second.
// An adjustment that also calibrates a lens takes about twice as long as others.
std::int64_t AdjustmentDelay(const Map& map);

}  // namespace plumbline
