// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <source_location>
#include <string>
#include <utility>

namespace plumbline::ros_node {

// What the node says, through its transport. All functions may be called in any thread.
class NodeLog {
 public:
  explicit NodeLog(Transport& transport) : transport_(transport) {}

  void Say(Severity severity, const std::string& line) { transport_.Log(severity, line); }
  // The same, every five seconds at most for each place in the code.
  void Throttled(Severity severity,
                 const std::string& line,
                 std::source_location place = std::source_location::current()) {
    constexpr std::chrono::seconds kInterval{5};
    {
      const std::lock_guard lock(mutex_);
      const auto now = std::chrono::steady_clock::now();
      const auto [last, is_first] = last_.try_emplace({place.file_name(), place.line()}, now);
      if (!is_first && now - last->second < kInterval) return;
      last->second = now;
    }
    Say(severity, line);
  }

 private:
  Transport& transport_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::uint_least32_t>, std::chrono::steady_clock::time_point>
      last_;
};

}  // namespace plumbline::ros_node
