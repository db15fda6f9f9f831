// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/atomic_file.h"

#include "apps/command_line.h"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Returns a name for each of several paths, as short as possible but different: the last parts of
// the path joined by "_", without ".txt". The second of two equal paths gets "-2" and so on.
std::vector<std::string> ShortNames(const std::vector<std::string>& paths);

// Outputs of `evaluate` and `lines`, by their options.
struct EvaluateOutputs {
  bool json_to_stdout = false;  // --json -
  std::optional<std::filesystem::path> json, plot;
  std::vector<std::filesystem::path> aligned;  // one for each estimate; empty: none
  // The folder of the aligned trajectories, if it has to be made.
  std::optional<std::filesystem::path> new_folder;
};

// Reads the options; `names` are those of the estimates (ShortNames), which name the aligned
// trajectories in a folder. Throws InputError for invalid names.
EvaluateOutputs ReadOutputs(const CommandLine& line, const std::vector<std::string>& names);

// Throws InputError if an output would replace an input of the comparison, files of a data set or
// of a run, a file of another kind, or another output. Changes nothing.
//
//   reference  the first argument
//   read       all input files
void CheckOutputs(const EvaluateOutputs& outputs,
                  const std::filesystem::path& reference,
                  const std::vector<std::filesystem::path>& read);

// Returns an aligned trajectory in TUM form, below a comment that describes it. Throws InputError,
// which names `file`, if ReadTrajectory would not read it (WriteTum).
FileContents AlignedFile(const std::filesystem::path& file, const Trajectory& aligned);

// Writes all files or none (WriteFilesAtomically).
void WriteOutputs(const EvaluateOutputs& outputs, const std::vector<FileContents>& files);

}  // namespace plumbline
