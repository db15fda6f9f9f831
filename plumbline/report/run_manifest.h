// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// List of the files that a run wrote into a folder: the file .plumbline-run beside them, in JSON.
// Later runs may replace or remove only listed files.
struct RunManifest {
  static constexpr const char* kFile = ".plumbline-run";

  bool complete = false;           // false while the run is in progress
  std::vector<std::string> files;  // names in the folder, ascending

  bool Lists(const std::string& name) const;
};

// Returns true for names of a run's files: trajectory.txt, trajectory_map2.txt, overlay_000010.png
// and so on.
bool IsRunFile(const std::string& name);

// Returns the names in a folder for which IsRunFile holds, ascending. Throws InputError if the
// folder cannot be listed.
std::vector<std::string> RunFilesIn(const std::filesystem::path& folder);

// Returns the manifest of a folder; nullopt if it has none. A folder written by a version without
// manifests gets one with all files of such names, if its summary.json repeats its options.yaml.
// Names that no run uses are ignored. Throws InputError "<file>: expected ..., found ..." for an
// invalid manifest.
std::optional<RunManifest> ReadRunManifest(const std::filesystem::path& folder);

// Replaces the manifest of a folder. Throws WriteError.
void WriteRunManifest(const std::filesystem::path& folder, const RunManifest& manifest);

}  // namespace plumbline
