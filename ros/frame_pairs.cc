// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_pairs.h"

#include <algorithm>
#include <cstdlib>

namespace plumbline::ros_node {

void FramePairs::Add(Queue& queue, std::int64_t stamp_ns, Bytes message) {
  // A bag that is played anew: those from before have no partners to come.
  if (!queue.empty() && stamp_ns < queue.back().stamp_ns) {
    first_.clear();
    second_.clear();
  }
  queue.push_back({stamp_ns, std::move(message)});
  while (approximate_ ? TakeNearest() : TakeExact()) {
  }
  if (queue.size() > queue_size_) queue.pop_front();
}

bool FramePairs::TakeExact() {
  if (first_.empty() || second_.empty()) return false;
  const std::int64_t first = first_.front().stamp_ns, second = second_.front().stamp_ns;
  if (first == second) {
    TakeFronts();
  } else {
    (first < second ? first_ : second_).pop_front();
  }
  return true;
}

bool FramePairs::TakeNearest() {
  if (first_.empty() || second_.empty()) return false;
  const auto distance = [this](const Message& second) {
    return std::abs(second.stamp_ns - first_.front().stamp_ns);
  };
  while (second_.size() > 1 && distance(second_[1]) <= distance(second_[0])) second_.pop_front();
  if (second_.front().stamp_ns == first_.front().stamp_ns) {
    TakeFronts();
    return true;
  }
  if (second_.back().stamp_ns < first_.front().stamp_ns) return false;  // a nearer one may come
  if (first_.size() == 1 && second_.front().stamp_ns > first_.front().stamp_ns) return false;
  // The next one of the first topic may be nearer to it.
  if (first_.size() > 1 &&
      std::abs(second_.front().stamp_ns - first_[1].stamp_ns) < distance(second_.front())) {
    first_.pop_front();
  } else {
    TakeFronts();
  }
  return true;
}

void FramePairs::TakeFronts() {
  const Message first = std::move(first_.front()), second = std::move(second_.front());
  first_.pop_front();
  second_.pop_front();
  take_(first.bytes, second.bytes);
}

}  // namespace plumbline::ros_node
