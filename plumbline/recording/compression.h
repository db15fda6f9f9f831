// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstdint>
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

}  // namespace plumbline
