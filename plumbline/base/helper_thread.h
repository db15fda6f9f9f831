// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

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

}  // namespace plumbline
