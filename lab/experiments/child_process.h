// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// A program that runs concurrently, without input, in a process group of its own: signals of the
// terminal do not reach it. It dies with the thread that started it.
class ChildProcess {
 public:
  // Starts command[0] with the other words as arguments; its output and messages go to the file
  // `log`. Throws InputError if the log cannot be written or no process can be made. A program that
  // cannot be started ends with code 127. `memory_mb` limits its address space: allocations beyond
  // fail.
  ChildProcess(const std::vector<std::string>& command,
               const std::filesystem::path& log,
               std::optional<int> memory_mb = std::nullopt);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  // Kills it and its descendants, if still running.
  ~ChildProcess();

  // End of a program: by itself with a code, or by a signal.
  struct End {
    int code = 0;
    std::optional<int> signal;
  };
  // Returns nullopt while it runs. Does not wait.
  std::optional<End> Poll();

 private:
  int id_ = 0;
  std::optional<End> end_;
};

}  // namespace plumbline
