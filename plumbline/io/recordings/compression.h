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

// Compression of the chunks of a recording. LZ4 and Zstandard are in their frame formats.
enum class Compression { kNone, kBzip2, kLz4, kZstd };

// Returns the `size` unpacked bytes, or the reason of the failure: damaged data, or more or fewer
// bytes than `size`. Takes at most twice the memory of the bytes unpacked so far, whatever `size`
// is.
Expected<std::vector<std::uint8_t>, std::string> Decompress(Compression compression,
                                                            std::span<const std::uint8_t> packed,
                                                            std::uint64_t size);

// Returns true if bytes begin like a Zstandard frame.
bool IsZstd(std::span<const std::uint8_t> bytes);
// Returns the content size in the header of a Zstandard frame; nullopt if it has none.
std::optional<std::uint64_t> ZstdSize(std::span<const std::uint8_t> bytes);

// Unpacks a file of Zstandard frames into another file. If it is damaged or ends early, returns the
// reason, and the output is the part before the fault. Throws InputError if one of the files cannot
// be opened, or if there is no room for the output. Takes little memory.
std::optional<std::string> UnpackZstdFile(const std::filesystem::path& from,
                                          const std::filesystem::path& to);

}  // namespace plumbline
