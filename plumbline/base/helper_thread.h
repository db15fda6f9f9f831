// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace plumbline {

// A thread that helps whoever asks, one caller at a time, and waits in between. What is shared by
// two threads for every frame is so without a new thread each time, which would have to queue
// behind whatever runs: a thread that wakes goes first.
class HelperThread {
 public:
  // Throws std::system_error when no thread can be started.
  HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  ~HelperThread();

  // Asks for work(), which may not throw; one call of Finish follows. False, and nothing is asked,
  // while it helps somebody else. Thread-safe.
  bool Ask(std::function<void()> work);
  // Returns when what this caller has asked for is done, or at once, without it, where it has not
  // begun: on a busy machine a caller that has done all the work itself waits for nothing.
  void Finish();

 private:
  void WorkUntilStopped();

  std::mutex mutex_;
  std::condition_variable asked_, done_;
  bool helping_ = false;
  bool working_ = false;
  bool stop_ = false;
  std::function<void()> work_;  // what is asked for and has not begun
  std::thread thread_;          // last, so that it finds the rest
};

}  // namespace plumbline
