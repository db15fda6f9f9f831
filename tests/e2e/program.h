// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/io/scratch_folder.h"
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumbline {

struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

inline std::string Quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// Runs the program that was built, after commands of the shell. `folder` takes its output.
inline Outcome RunProgram(const ScratchFolder& folder,
                          const std::string& arguments,
                          const std::string& before = "") {
  const std::string command = before + "'" PLUMBLINE_BINARY "' " + arguments + " > " +
                              Quoted(folder / "stdout") + " 2> " + Quoted(folder / "stderr");
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
  return {WEXITSTATUS(status), Contents(folder / "stdout"), Contents(folder / "stderr")};
}

// Starts the program without waiting for it; its output goes nowhere.
inline pid_t StartProgram(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), PLUMBLINE_BINARY);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int null = ::open("/dev/null", O_WRONLY);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  return child;
}

// Waits, at most a minute, until there is such a file.
inline bool WaitForFile(const std::filesystem::path& path) {
  for (int i = 0; i < 60000 && !std::filesystem::exists(path); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return std::filesystem::exists(path);
}

inline std::set<std::string> FilesOf(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

// Those of the files of a run that must have the same bytes in every run.
inline bool IsRepeatable(const std::string& name) {
  return name.starts_with("trajectory") || name.starts_with("keyframes") || name == "frames.csv" ||
         name.starts_with("map.") || name == "lines.obj" || name == "lines.dxf";
}

}  // namespace plumbline
