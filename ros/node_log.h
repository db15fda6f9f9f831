// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

namespace plumbline::ros_node {

// What the node says, through its transport. All functions may be called in any thread.
class NodeLog {
 public:
  explicit NodeLog(Transport& transport) : transport_(transport) {}

  void Say(Severity severity, const std::string& line) { transport_.Log(severity, line); }
  // The same, every five seconds at most for each place in the code, and each topic if it names
  // one.
  void Throttled(Severity severity,
                 const std::string& line,
                 const std::string& topic = "",
                 const char* file = __builtin_FILE(),
                 int line_of_file = __builtin_LINE()) {
    constexpr std::chrono::seconds kInterval{5};
    {
      const std::lock_guard lock(mutex_);
      const auto now = std::chrono::steady_clock::now();
      const auto [last, is_first] = last_.try_emplace({file, line_of_file, topic}, now);
      if (!is_first && now - last->second < kInterval) return;
      last->second = now;
    }
    Say(severity, line);
  }
  // A message of a topic that is none of its type (throttled).
  void Refuse(const TopicSettings& topic, std::size_t bytes) {
    Throttled(Severity::kError,
              "a message is left out: " + topic.name + ": expected a " + topic.type + ", found " +
                  std::to_string(bytes) + " bytes that are none",
              topic.name);
  }

 private:
  Transport& transport_;
  std::mutex mutex_;
  using Place = std::tuple<std::string, int, std::string>;
  std::map<Place, std::chrono::steady_clock::time_point> last_;
};

}  // namespace plumbline::ros_node
