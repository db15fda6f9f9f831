// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// How the parts of a recording are packed. LZ4 and Zstandard are in their frame formats.
enum class Compression { kNone, kBzip2, kLz4, kZstd };

// The `size` bytes that were packed, or why they cannot be had: damaged, more or fewer bytes than
// `size`. Takes no more memory than what has been unpacked so far, twice, whatever `size` says.
Expected<std::vector<std::uint8_t>, std::string> Decompress(Compression compression,
                                                            std::span<const std::uint8_t> packed,
                                                            std::uint64_t size);

}  // namespace plumbline
