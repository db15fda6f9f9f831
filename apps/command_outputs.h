// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

// An output named by a user replaces only files of its own kind (docs/adr/0016); one rule for the
// program and for Python.
namespace plumbline {

// Kind of files that a command writes to paths of users.
struct FileKind {
  std::string_view name;   // "a map"
  std::string_view begin;  // first bytes of each of them
  // Returns true if a file with these first bytes is of this kind; null: always.
  bool (*is_one)(const std::filesystem::path& file) = nullptr;
};

// Maps (map.plb), and trajectories written by WriteTum.
FileKind MapFileKind();
FileKind TrajectoryFileKind();

// Throws InputError, which names the option, if `file` exists, is not empty and is of another kind:
// it would be lost. Changes nothing.
void CheckReplacesItsKind(std::string_view option,
                          const std::filesystem::path& file,
                          const FileKind& kind);

// Throws InputError, which names both options, if two outputs of a command are one file. Outputs
// are options with their files.
void CheckApartFromEachOther(
    std::span<const std::pair<std::string_view, std::filesystem::path>> outputs);

// Throws InputError, which names the option, if a file would replace a result of the run in whose
// folder it is (CheckNoResult). Changes nothing.
void CheckKeepsResults(std::string_view option, const std::filesystem::path& file);

// Throws InputError, which names the option, if `output` would replace an input (by whatever name:
// reading does not permit writing), a result of a run, or a file of another kind, and for "-",
// which elsewhere means standard output. Changes nothing.
void CheckOutput(std::string_view option,
                 const std::filesystem::path& output,
                 std::span<const std::filesystem::path> inputs,
                 const FileKind& kind);

}  // namespace plumbline
