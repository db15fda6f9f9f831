// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace plumbline {

// A thread that helps one caller at a time, and waits in between. Work that two threads share for
// every frame thus needs no new thread each time. A new thread would have to queue behind all that
// runs; a thread that wakes goes first.
class HelperThread {
 public:
  // Throws std::system_error when no thread can be started.
  HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  ~HelperThread();

  // Asks for work(), which may not throw; one call of Finish must follow. Returns false, and asks
  // for nothing, while the thread helps another caller. Thread-safe.
  bool Ask(std::function<void()> work);
  // Returns when the work that this caller has asked for is done, or at once, without doing it,
  // where it has not begun: on a busy machine a caller that has done all the work itself waits for
  // nothing.
  void Finish();

 private:
  void WorkUntilStopped();

  std::mutex mutex_;
  std::condition_variable asked_, done_;
  bool helping_ = false;
  bool working_ = false;
  bool stop_ = false;
  std::function<void()> work_;  // work that was asked for and has not begun
  std::thread thread_;          // declared last, so that it is started when the other members exist
};

}  // namespace plumbline
