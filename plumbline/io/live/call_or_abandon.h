// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <thread>
#include <utility>

namespace plumbline {

// Calls a function that may never return, such as one that waits for a camera, in a thread of its
// own. Meanwhile `go_on` is called every 50 ms; once it returns false, the result is nullopt, and
// the thread is left to itself: what the function uses must be its own. Rethrows exceptions of both
// functions. Throws std::system_error if no thread can be started, which takes some 30 us.
template <class Result>
std::optional<Result> CallOrAbandon(std::function<Result()> call,
                                    const std::function<bool()>& go_on) {
  constexpr std::chrono::milliseconds kAskEvery(50);
  std::packaged_task<Result()> task(std::move(call));
  std::future<Result> result = task.get_future();
  std::thread(std::move(task)).detach();
  while (result.wait_for(kAskEvery) != std::future_status::ready) {
    if (!go_on()) return std::nullopt;
  }
  return result.get();
}

}  // namespace plumbline
