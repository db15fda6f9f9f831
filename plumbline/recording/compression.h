// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// How the parts of a recording are compressed. LZ4 and Zstandard are in their frame formats.
enum class Compression { kNone, kBzip2, kLz4, kZstd };

// Returns the `size` bytes that were packed, or why that fails: damaged data, or more or fewer
// bytes than `size`. Takes at most twice the memory of what has been unpacked so far, whatever
// `size` says.
Expected<std::vector<std::uint8_t>, std::string> Decompress(Compression compression,
                                                            std::span<const std::uint8_t> packed,
                                                            std::uint64_t size);

// Whether bytes begin as a Zstandard frame does.
bool IsZstd(std::span<const std::uint8_t> bytes);
// Returns how many bytes a Zstandard frame says that it holds; nullopt where it says nothing.
std::optional<std::uint64_t> ZstdSize(std::span<const std::uint8_t> bytes);

// Unpacks a file of Zstandard frames into another file. Returns why it is not whole, where it is
// damaged or ends early: then what comes before is there. Throws InputError where one of the files
// cannot be opened, or where there is no room for the other one. Takes little memory.
std::optional<std::string> UnpackZstdFile(const std::filesystem::path& from,
                                          const std::filesystem::path& to);

}  // namespace plumbline
