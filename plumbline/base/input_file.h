// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline {

// Maximum sizes of files that are read whole, in bytes: settings, written by hand, and tables.
constexpr std::uint64_t kLargestSettings = std::uint64_t{1} << 20;
constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 30;

// Returns the contents of a file that a user named. Throws InputError "path: ..." if it does not
// exist, is a folder, a pipe or a device (reading might block forever), is larger than `largest`
// bytes, or cannot be read.
std::string ReadInputFile(const std::filesystem::path& path, std::uint64_t largest = kLargestTable);

// Returns the contents of an optional file; nullopt if ReadInputFile would fail.
std::optional<std::string> ReadFileIfThere(const std::filesystem::path& path);

// Returns true if the file at `path` exists and begins with `text`; reads no more of it.
bool FileBeginsWith(const std::filesystem::path& path, std::string_view text);

// Throws InputError "<file>: not written by an earlier <writer> ..." for the first entry of
// `folder` by name whose name `is_foreign` accepts. Foreign entries are those that a command would
// replace but did not write itself (judged by a manifest, or by the first bytes of a file beside
// them). Entries of every kind count, even dangling links. Throws InputError also if the folder
// cannot be listed; does nothing if it does not exist. Changes no file.
void RefuseForeignFiles(const std::filesystem::path& folder,
                        std::string_view writer,
                        const std::function<bool(const std::string& name)>& is_foreign);

// Returns true if the path exists. Links count by themselves, even dangling ones, since entries of
// others must not be replaced.
bool IsTaken(const std::filesystem::path& path);

// Throws InputError "path: no such <what>" where there is nothing at the path, and "path: cannot be
// read: ..." where that cannot be found out (a link onto itself, a folder that nobody may enter).
void CheckExists(const std::filesystem::path& path, std::string_view what = "file");

// Returns what is at an existing path: "a folder", "a file", "a pipe", "a device", "a socket".
std::string KindOf(const std::filesystem::path& path);

}  // namespace plumbline
