// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

// An output that a user names replaces files of its own kind only (docs/adr/0016); one rule for the
// program and for Python.
namespace plumbline {

// Files that a command writes to a place that users name.
struct FileKind {
  std::string_view name;   // "a map"
  std::string_view begin;  // what each of them begins with
  // Whether a file that begins so is one; null: it is.
  bool (*is_one)(const std::filesystem::path& file) = nullptr;
};

// Maps (map.plb), and trajectories as WriteTum writes them.
FileKind MapFileKind();
FileKind TrajectoryFileKind();

// Throws InputError, which names the option, when there is a file at `file` that is not empty and
// of another kind: somebody else's would be lost. Touches nothing.
void CheckReplacesItsKind(std::string_view option,
                          const std::filesystem::path& file,
                          const FileKind& kind);

// Throws InputError, which names both options, when two outputs of a command are one file. Outputs
// are options with their files.
void CheckApartFromEachOther(
    std::span<const std::pair<std::string_view, std::filesystem::path>> outputs);

// Throws InputError, which names the option, when a file would take the place of a result of the
// run whose folder it is to lie in (CheckNoResult). Touches nothing.
void CheckKeepsResults(std::string_view option, const std::filesystem::path& file);

// Throws InputError, which names the option, where writing `output` would take the place of what is
// read (by whatever name: reading it is no leave to write over it), of a result of a run, or of a
// file of another kind, and for "-", which elsewhere means standard output. Touches nothing.
void CheckOutput(std::string_view option,
                 const std::filesystem::path& output,
                 std::span<const std::filesystem::path> inputs,
                 const FileKind& kind);

}  // namespace plumbline
