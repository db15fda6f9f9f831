// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// The list of the files that a run wrote into a folder: the file .plumbline-run beside them, in
// JSON. Only files that are listed there may be replaced or removed by later runs.
struct RunManifest {
  static constexpr const char* kFile = ".plumbline-run";

  bool complete = false;           // false while the run is under way
  std::vector<std::string> files;  // names in the folder, ascending

  bool Lists(const std::string& name) const;
};

// Whether a run may write a file of this name: trajectory.txt, trajectory_map2.txt,
// overlay_000010.png and so on.
bool IsRunFile(const std::string& name);

// Returns the names in a folder for which IsRunFile holds, ascending. Throws InputError when the
// folder cannot be listed.
std::vector<std::string> RunFilesIn(const std::filesystem::path& folder);

// Returns the manifest of a folder; nullopt where there is none. Names that no run uses are left
// out, whatever the file says. Throws InputError
// "<file>: expected ..., found ..." when it is no manifest.
std::optional<RunManifest> ReadRunManifest(const std::filesystem::path& folder);

// Replaces the manifest of a folder. Throws WriteError.
void WriteRunManifest(const std::filesystem::path& folder, const RunManifest& manifest);

}  // namespace plumbline
