// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/io/scratch_folder.h"
#include <cstdlib>
#include <string>

#include <sys/wait.h>

namespace plumbline {

struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

inline std::string Quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// Runs the program that was built. `folder` takes its output.
inline Outcome RunProgram(const ScratchFolder& folder, const std::string& arguments) {
  const std::string command = "'" PLUMBLINE_BINARY "' " + arguments + " > " +
                              Quoted(folder / "stdout") + " 2> " + Quoted(folder / "stderr");
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
  return {WEXITSTATUS(status), Contents(folder / "stdout"), Contents(folder / "stderr")};
}

}  // namespace plumbline
