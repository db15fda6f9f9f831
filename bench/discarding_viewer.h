// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace plumbline {

// A client of the viewer that asks for all channels and throws away what it is sent, in a thread of
// its own. It waits until somebody listens on the port, and ends when the server closes.
class DiscardingViewer {
 public:
  explicit DiscardingViewer(std::uint16_t port);
  ~DiscardingViewer();
  DiscardingViewer(const DiscardingViewer&) = delete;
  DiscardingViewer& operator=(const DiscardingViewer&) = delete;

  // Size of all messages that it was sent so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  void Watch(std::uint16_t port);

  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::thread thread_;
};

}  // namespace plumbline
