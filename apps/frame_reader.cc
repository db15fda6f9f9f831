// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_reader.h"

#include "plumbline/base/error.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

namespace plumbline {
namespace {

constexpr std::chrono::milliseconds kAskEvery(50);
constexpr std::chrono::milliseconds kGrace(250);

}  // namespace

// Shared with the thread, which may outlive the reader.
struct FrameReader::Exchange {
  explicit Exchange(std::shared_ptr<const Dataset> read) : dataset(std::move(read)) {}

  std::shared_ptr<const Dataset> dataset;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<std::size_t> wanted;
  std::optional<Expected<SensorFrame, ImageFailure>> result;
  std::exception_ptr failure;
  bool end = false;

  bool Answered() const { return result || failure; }
};

FrameReader::FrameReader(std::shared_ptr<const Dataset> dataset)
    : exchange_(std::make_shared<Exchange>(std::move(dataset))),
      thread_([exchange = exchange_] { Work(exchange); }) {}

FrameReader::~FrameReader() {
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

void FrameReader::Work(const std::shared_ptr<Exchange>& exchange) {
  std::unique_lock lock(exchange->mutex);
  while (true) {
    exchange->changed.wait(lock, [&] { return exchange->end || exchange->wanted; });
    if (exchange->end) return;
    const std::size_t frame = *std::exchange(exchange->wanted, std::nullopt);
    lock.unlock();
    std::optional<Expected<SensorFrame, ImageFailure>> result;
    std::exception_ptr failure;
    try {
      result = exchange->dataset->Read(frame);
    } catch (...) {  // rethrown in the thread that waits
      failure = std::current_exception();
    }
    lock.lock();
    exchange->result = std::move(result);
    exchange->failure = failure;
    exchange->changed.notify_all();
  }
}

std::optional<Expected<SensorFrame, ImageFailure>> FrameReader::Read(
    std::size_t frame, const std::function<bool()>& go_on) {
  PLUMBLINE_CHECK(!given_up_, "reading goes on after it was given up");
  std::unique_lock lock(exchange_->mutex);
  exchange_->wanted = frame;
  exchange_->changed.notify_all();
  const auto answered = [&] { return exchange_->Answered(); };
  while (!exchange_->changed.wait_for(lock, kAskEvery, answered)) {
    lock.unlock();
    const bool more = go_on();
    lock.lock();
    if (more || exchange_->changed.wait_for(lock, kGrace, answered)) continue;
    given_up_ = true;
    return std::nullopt;
  }
  if (exchange_->failure) std::rethrow_exception(std::exchange(exchange_->failure, nullptr));
  return std::exchange(exchange_->result, std::nullopt);
}

}  // namespace plumbline
