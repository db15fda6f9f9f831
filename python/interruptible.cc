// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "interruptible.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <pybind11/pybind11.h>

namespace plumbline::python {
namespace {

namespace py = pybind11;

// Work in a thread.
class Worker {
 public:
  explicit Worker(const std::function<void(const StopCheck&)>& work)
      : thread_([this, &work] { Do(work); }) {}

  // Returns true if the work was done within the time.
  bool WaitFor(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return done_.wait_for(lock, time, [this] { return is_done_; });
  }
  void Stop() { stop_ = true; }
  void RethrowFailure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void Do(const std::function<void(const StopCheck&)>& work) {
    try {
      work([this] { return stop_.load(); });
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    is_done_ = true;
    done_.notify_all();
  }

  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace

void RunInterruptibly(const std::function<void(const StopCheck&)>& work) {
  std::optional<py::error_already_set> interrupt;
  {
    Worker worker(work);
    const auto done = [&worker] {
      const py::gil_scoped_release release;
      return worker.WaitFor(std::chrono::milliseconds(50));
    };
    while (!done()) {
      if (PyErr_CheckSignals() == 0) continue;
      interrupt.emplace();
      worker.Stop();
    }
    if (!interrupt) worker.RethrowFailure();
  }
  if (interrupt) throw py::error_already_set(*interrupt);
}

}  // namespace plumbline::python
