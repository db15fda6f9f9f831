// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace plumbline {

// Calls a function that may take for ever in a thread of its own, so that a disk, a network or a
// camera that does not answer holds nobody up.
template <class Result>
class PatientReader {
 public:
  using Function = std::function<Result(std::size_t)>;

  // Throws std::system_error when no thread can be started.
  explicit PatientReader(Function read)
      : exchange_(std::make_shared<Exchange>(std::move(read))),
        thread_([exchange = exchange_] { Work(exchange); }) {}
  PatientReader(const PatientReader&) = delete;
  PatientReader& operator=(const PatientReader&) = delete;
  // Does not wait for a call that was given up: its thread stays behind until it ends.
  ~PatientReader() {
    {
      const std::lock_guard lock(exchange_->mutex);
      exchange_->end = true;
      exchange_->changed.notify_all();
    }
    if (given_up_) {
      thread_.detach();
    } else {
      thread_.join();
    }
  }

  // What the function returns for `which`. `go_on` is asked about every 50 ms while that takes;
  // when it says no, the call has a quarter of a second more, then it is given up: nullopt, and
  // nothing can be read any more, as when it throws. Rethrows what either function throws.
  std::optional<Result> Read(std::size_t which, const std::function<bool()>& go_on) {
    constexpr std::chrono::milliseconds kAskEvery(50);
    constexpr std::chrono::milliseconds kGrace(250);
    PLUMBLINE_CHECK(!given_up_, "reading goes on after it was given up");
    std::unique_lock lock(exchange_->mutex);
    exchange_->wanted = which;
    exchange_->changed.notify_all();
    const auto answered = [&] { return exchange_->Answered(); };
    while (!exchange_->changed.wait_for(lock, kAskEvery, answered)) {
      lock.unlock();
      given_up_ = true;  // unless `go_on` returns
      const bool more = go_on();
      given_up_ = false;
      lock.lock();
      if (more || exchange_->changed.wait_for(lock, kGrace, answered)) continue;
      given_up_ = true;
      return std::nullopt;
    }
    if (exchange_->failure) std::rethrow_exception(std::exchange(exchange_->failure, nullptr));
    return std::exchange(exchange_->result, std::nullopt);
  }

 private:
  // Shared with the thread, which may outlive the reader.
  struct Exchange {
    explicit Exchange(Function function) : read(std::move(function)) {}

    Function read;
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<std::size_t> wanted;
    std::optional<Result> result;
    std::exception_ptr failure;
    bool end = false;

    bool Answered() const { return result || failure; }
  };

  static void Work(const std::shared_ptr<Exchange>& exchange) {
    std::unique_lock lock(exchange->mutex);
    while (true) {
      exchange->changed.wait(lock, [&] { return exchange->end || exchange->wanted; });
      if (exchange->end) return;
      const std::size_t which = *std::exchange(exchange->wanted, std::nullopt);
      lock.unlock();
      std::optional<Result> result;
      std::exception_ptr failure;
      try {
        result = exchange->read(which);
      } catch (...) {  // rethrown in the thread that waits
        failure = std::current_exception();
      }
      lock.lock();
      exchange->result = std::move(result);
      exchange->failure = failure;
      exchange->changed.notify_all();
    }
  }

  std::shared_ptr<Exchange> exchange_;
  bool given_up_ = false;
  std::thread thread_;
};

}  // namespace plumbline
