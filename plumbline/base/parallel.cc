// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"

#include <utility>

#include <pthread.h>
#include <sched.h>

namespace plumbline {

namespace {

// Moves a thread to another processor than the caller's, if the program may use more than one.
// Linux wakes a thread on the processor of the waking one if the other processors seem busy, as
// idle ones of a virtual machine do, and moves it some milliseconds later.
void LeaveProcessorOfCaller(pthread_t thread) {
  cpu_set_t others;
  const int here = sched_getcpu();
  if (here < 0 || pthread_getaffinity_np(pthread_self(), sizeof(others), &others) != 0) return;
  CPU_CLR(here, &others);
  if (CPU_COUNT(&others) > 0) pthread_setaffinity_np(thread, sizeof(others), &others);
}

}  // namespace

HelperThread::HelperThread() : thread_([this] { WorkUntilStopped(); }) {}

HelperThread::~HelperThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  asked_.notify_one();
  thread_.join();
}

bool HelperThread::Ask(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    if (helping_) return false;
    helping_ = true;
    work_ = std::move(work);
  }
  LeaveProcessorOfCaller(thread_.native_handle());
  asked_.notify_one();
  return true;
}

void HelperThread::Finish() {
  std::unique_lock lock(mutex_);
  work_ = nullptr;
  done_.wait(lock, [this] { return !working_; });
  helping_ = false;
}

void HelperThread::WorkUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    asked_.wait(lock, [this] { return stop_ || work_; });
    if (stop_) return;
    const std::function<void()> work = std::exchange(work_, nullptr);
    working_ = true;
    lock.unlock();
    work();
    lock.lock();
    working_ = false;
    done_.notify_one();
  }
}

}  // namespace plumbline
