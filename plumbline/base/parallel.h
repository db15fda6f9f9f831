// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace plumbline {

// Calls fn(i) once for every i in [0, n), on up to `threads` threads (the caller's among them);
// threads <= 1 runs in the caller's thread, in order. fn(i) may write only what belongs to i, so
// that the result does not depend on the number of threads.
//
// Returns when all calls are done. If calls throw, the exception of the least i is rethrown; calls
// not yet begun by then are left out. Cost: starting the threads, some 20 us each.
template <class Function>
void ParallelFor(int n, int threads, const Function& fn) {
  if (threads <= 1 || n <= 1) {
    for (int i = 0; i < n; ++i) fn(i);
    return;
  }
  std::atomic<int> next{0};
  std::mutex mutex;
  int failed_index = n;
  std::exception_ptr failure;
  const auto keep_failure = [&](int i) {
    const std::lock_guard lock(mutex);
    if (i >= failed_index) return;
    failed_index = i;
    failure = std::current_exception();
  };
  const auto work = [&] {
    for (int i = next.fetch_add(1); i < n; i = next.fetch_add(1)) {
      try {
        fn(i);
      } catch (...) {  // rethrown in the caller's thread below
        keep_failure(i);
        next.store(n);
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(threads, n); ++i) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

// The results fn(0), ..., fn(n - 1) in this order. The type of the results needs a default value.
template <class Result, class Function>
std::vector<Result> ParallelMap(int n, int threads, const Function& fn) {
  std::vector<Result> results(static_cast<std::size_t>(std::max(n, 0)));
  ParallelFor(n, threads, [&](int i) { results[static_cast<std::size_t>(i)] = fn(i); });
  return results;
}

}  // namespace plumbline
