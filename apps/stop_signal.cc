// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/stop_signal.h"

#include <atomic>
#include <chrono>
#include <csignal>

namespace plumbline {
namespace {

// Signals belong to the whole process, and so do these. The handler may use them because they are
// lock-free.
std::atomic<int> first_signal{0};
std::atomic<int> signal_count{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void RequestStop(int signal) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  signal_count.fetch_add(1);
}

}  // namespace

void CatchStopSignals() {
  std::signal(SIGINT, RequestStop);
  std::signal(SIGTERM, RequestStop);
  if (std::signal(SIGHUP, RequestStop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool StopRequested() { return signal_count.load() > 0; }

void IgnoreBrokenPipes() { std::signal(SIGPIPE, SIG_IGN); }

std::optional<StopSignal> FirstStopSignal() {
  switch (first_signal.load()) {
    case SIGINT:
      return StopSignal{"SIGINT", 128 + SIGINT};
    case SIGTERM:
      return StopSignal{"SIGTERM", 128 + SIGTERM};
    case SIGHUP:
      return StopSignal{"SIGHUP", 128 + SIGTERM};
    default:
      return std::nullopt;
  }
}

StopCheck StepStop() {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kTimeLeft(1);
  const int before = signal_count.load();
  const auto start = Clock::now();
  return [before, start] {
    return before > 1 || signal_count.load() > before ||
           (before > 0 && Clock::now() - start > kTimeLeft);
  };
}

}  // namespace plumbline
