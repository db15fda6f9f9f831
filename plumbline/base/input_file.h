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

// Largest files that are read whole, in bytes: what is written by hand, and tables.
constexpr std::uint64_t kLargestSettings = std::uint64_t{1} << 20;
constexpr std::uint64_t kLargestTable = std::uint64_t{1} << 30;

// The contents of a file that somebody named. InputError "path: ..." when there is none, when it is
// a folder, a pipe or a device (reading might wait for ever), larger than `largest` bytes or cannot
// be read.
std::string ReadInputFile(const std::filesystem::path& path, std::uint64_t largest = kLargestTable);

// The contents of a file that need not be there; none where ReadInputFile would fail.
std::optional<std::string> ReadFileIfThere(const std::filesystem::path& path);

// Whether there is a file at `path` that begins with `text`; no more of it is read.
bool FileBeginsWith(const std::filesystem::path& path, std::string_view text);

// Throws InputError "<file>: not written by an earlier <writer> ..." when `is_foreign` takes the
// name of an entry of `folder`, the first by name: of the names that a command would replace, those
// that it does not know for its own (by a manifest, or by how a file beside them begins). Whatever
// the entry is counts, also a link that leads nowhere. InputError, too, where the folder cannot be
// listed; nothing where there is none. Touches nothing.
void RefuseForeignFiles(const std::filesystem::path& folder,
                        std::string_view writer,
                        const std::function<bool(const std::string& name)>& is_foreign);

// What is at a path that is there: "a folder", "a file", "a pipe", "a device", "a socket".
std::string KindOf(const std::filesystem::path& path);

}  // namespace plumbline
