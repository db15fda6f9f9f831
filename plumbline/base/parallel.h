// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace plumbline {

// A thread that helps one caller at a time and sleeps in between, so that work shared by two
// threads in every frame needs no new thread. A new thread would queue behind all running ones; a
// thread that wakes up is scheduled first.
class HelperThread {
 public:
  // Throws std::system_error if no thread can be started.
  HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  ~HelperThread();

  // Requests work(), which must not throw; one call of Finish must follow. Returns false, and
  // requests nothing, while the thread helps another caller. Thread-safe.
  bool Ask(std::function<void()> work);
  // Waits until the work requested by this caller is done. Work that has not begun is cancelled, so
  // that on a busy machine a caller that has done everything itself does not wait.
  void Finish();

 private:
  void WorkUntilStopped();

  std::mutex mutex_;
  std::condition_variable asked_, done_;
  bool helping_ = false;
  bool working_ = false;
  bool stop_ = false;
  std::function<void()> work_;  // requested work that has not begun
  std::thread thread_;          // declared last: it starts after all other members exist
};

// Calls of fn(i) for i in [0, n), shared by several threads.
template <class Function>
class SharedCalls {
 public:
  SharedCalls(int n, const Function& fn) : n_(n), fn_(fn), failed_index_(n) {}

  // Makes one call after the other until none is left. Called by every participating thread.
  void Work() {
    for (int i = next_.fetch_add(1); i < n_; i = next_.fetch_add(1)) {
      try {
        fn_(i);
      } catch (...) {  // rethrown in the caller's thread
        KeepFailure(i);
        next_.store(n_);
      }
    }
  }

  // Rethrows the exception of the least i, if any. Call after all threads have ended.
  void Rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void KeepFailure(int i) {
    const std::lock_guard lock(mutex_);
    if (i >= failed_index_) return;
    failed_index_ = i;
    failure_ = std::current_exception();
  }

  const int n_;
  const Function& fn_;
  std::atomic<int> next_{0};
  std::mutex mutex_;
  int failed_index_;
  std::exception_ptr failure_;
};

// Calls fn(i) once for every i in [0, n), on up to `threads` threads (the caller's among them);
// threads <= 1 runs in the caller's thread, in order. fn(i) must write only data of index i, so
// that the result does not depend on the number of threads.
//
// Returns when all calls are done. If calls throw, the exception of the least i is rethrown, and
// calls that have not begun by then are skipped. Cost: starting the threads, about 20 us each.
template <class Function>
void ParallelFor(int n, int threads, const Function& fn) {
  if (threads <= 1 || n <= 1) {
    for (int i = 0; i < n; ++i) fn(i);
    return;
  }
  SharedCalls<Function> calls(n, fn);
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(threads, n); ++i) helpers.emplace_back([&] { calls.Work(); });
    calls.Work();
  }
  calls.Rethrow();
}

// Calls fn(i) once for every i in [0, n), in the caller's thread and in the helper's if it is free.
template <class Function>
void ParallelFor(int n, HelperThread* helper, const Function& fn) {
  SharedCalls<Function> calls(n, fn);
  const bool helped = helper != nullptr && n > 1 && helper->Ask([&] { calls.Work(); });
  calls.Work();
  if (helped) helper->Finish();
  calls.Rethrow();
}

// Calls fn(begin, end) for consecutive ranges that make up [0, n), each but the last of `length`
// indices, in the caller's thread and in the helper's if it is free.
template <class Function>
void ParallelForRanges(std::size_t n,
                       std::size_t length,
                       HelperThread* helper,
                       const Function& fn) {
  ParallelFor(static_cast<int>((n + length - 1) / length), helper, [&](int i) {
    const std::size_t begin = static_cast<std::size_t>(i) * length;
    fn(begin, std::min(begin + length, n));
  });
}

// Returns the results fn(0), ..., fn(n - 1) in this order. Their type needs a default value.
template <class Result, class Function>
std::vector<Result> ParallelMap(int n, int threads, const Function& fn) {
  std::vector<Result> results(static_cast<std::size_t>(std::max(n, 0)));
  ParallelFor(n, threads, [&](int i) { results[static_cast<std::size_t>(i)] = fn(i); });
  return results;
}

}  // namespace plumbline
