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

// Calls a function that may never return in a thread of its own, so that an unresponsive disk,
// network or camera does not block the caller.
template <class Result>
class PatientReader {
 public:
  using Function = std::function<Result(std::size_t)>;

  // Throws std::system_error if no thread can be started.
  explicit PatientReader(Function read)
      : exchange_(std::make_shared<Exchange>(std::move(read))),
        thread_([exchange = exchange_] { Work(exchange); }) {}
  PatientReader(const PatientReader&) = delete;
  PatientReader& operator=(const PatientReader&) = delete;
  // Does not wait for an abandoned call: its thread remains until it ends.
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

  // Returns the result of the function for `which`. Meanwhile `go_on` is called about every 50 ms;
  // once it returns false, the call has another quarter of a second, then it is abandoned: the
  // result is nullopt, and nothing can be read any more, as after an exception. Rethrows exceptions
  // of both functions.
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
      } catch (...) {  // rethrown in the waiting thread
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
