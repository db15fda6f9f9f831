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

// Largest files that are read whole, in bytes: settings, which are written by hand, and tables.
constexpr std::uint64_t kLargestSettings = std::uint64_t{1} << 20;
constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 30;

// Returns the contents of a file that a user named. Throws InputError "path: ..." when there is
// none, when it is a folder, a pipe or a device (reading might wait for ever), when it is larger
// than `largest` bytes, or when it cannot be read.
std::string ReadInputFile(const std::filesystem::path& path, std::uint64_t largest = kLargestTable);

// Returns the contents of a file that need not be there; nullopt where ReadInputFile would fail.
std::optional<std::string> ReadFileIfThere(const std::filesystem::path& path);

// Whether there is a file at `path` that begins with `text`; no more of it is read.
bool FileBeginsWith(const std::filesystem::path& path, std::string_view text);

// Throws InputError "<file>: not written by an earlier <writer> ..." when `is_foreign` accepts the
// name of an entry of `folder`, for the first such entry by name. Foreign are names that a command
// would replace and does not know as its own (by a manifest, or by how a file beside them begins).
// Every kind of entry counts, even a link that leads nowhere. Throws InputError also where the
// folder cannot be listed; does nothing where there is none. Changes no file.
void RefuseForeignFiles(const std::filesystem::path& folder,
                        std::string_view writer,
                        const std::function<bool(const std::string& name)>& is_foreign);

// Whether there is something at the path. A link counts by itself, even where it leads nowhere,
// since what others put there must not be replaced.
bool IsTaken(const std::filesystem::path& path);

// Throws InputError "path: no such <what>" where there is nothing at the path, and "path: cannot be
// read: ..." where that cannot be found out (a link onto itself, a folder that nobody may enter).
void CheckExists(const std::filesystem::path& path, std::string_view what = "file");

// Returns what is at an existing path: "a folder", "a file", "a pipe", "a device", "a socket".
std::string KindOf(const std::filesystem::path& path);

}  // namespace plumbline
