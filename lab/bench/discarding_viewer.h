// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace plumbline {

// A client of the viewer that subscribes to all channels and discards all messages, in a thread of
// its own. It waits until the port is open, and ends when the server closes.
class DiscardingViewer {
 public:
  explicit DiscardingViewer(std::uint16_t port);
  ~DiscardingViewer();
  DiscardingViewer(const DiscardingViewer&) = delete;
  DiscardingViewer& operator=(const DiscardingViewer&) = delete;

  // Size of all messages received so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  void Watch(std::uint16_t port);

  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::thread thread_;
};

}  // namespace plumbline
