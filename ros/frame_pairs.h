// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

namespace plumbline::ros_node {

// Puts together messages of two topics that belong to one instant: those with equal stamps, or, if
// `approximate`, each of the first topic with the nearest of the second, known when a later one of
// it has come. A message is part of one pair at most, and pairs are in order of time. Of each topic
// `queue_size` messages wait; older ones are left out.
class FramePairs {
 public:
  // Bytes of the first and the second topic.
  using Take = std::function<void(const Bytes& first, const Bytes& second)>;

  FramePairs(bool approximate, std::size_t queue_size, Take take)
      : approximate_(approximate), queue_size_(queue_size), take_(std::move(take)) {}

  void AddFirst(std::int64_t stamp_ns, Bytes message) { Add(first_, stamp_ns, std::move(message)); }
  void AddSecond(std::int64_t stamp_ns, Bytes message) {
    Add(second_, stamp_ns, std::move(message));
  }

 private:
  struct Message {
    std::int64_t stamp_ns = 0;
    Bytes bytes;
  };
  using Queue = std::deque<Message>;

  void Add(Queue& queue, std::int64_t stamp_ns, Bytes message);
  // Takes one pair, or leaves out what has none; false if more messages are needed for either.
  bool TakeExact();
  bool TakeNearest();
  void TakeFronts();

  bool approximate_;
  std::size_t queue_size_;
  Take take_;
  Queue first_, second_;  // by time
};

}  // namespace plumbline::ros_node
