// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// A program run beside this one, without input, in a process group of its own: what is typed at the
// terminal does not reach it. It dies with the thread that started it.
class ChildProcess {
 public:
  // Starts command[0] with the other words as arguments; its output and messages go to the file
  // `log`. Throws InputError when the log cannot be written or no process be made. A program that
  // cannot be started ends with code 127. With `memory_mb` its address space is limited to so much:
  // what it asks for beyond is refused.
  ChildProcess(const std::vector<std::string>& command,
               const std::filesystem::path& log,
               std::optional<int> memory_mb = std::nullopt);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  // Kills it, and what it started, where it still runs.
  ~ChildProcess();

  // How a program ended: by itself with a code, or by a signal.
  struct End {
    int code = 0;
    std::optional<int> signal;
  };
  // nullopt while it runs. Does not wait.
  std::optional<End> Poll();

 private:
  int id_ = 0;
  std::optional<End> end_;
};

}  // namespace plumbline
