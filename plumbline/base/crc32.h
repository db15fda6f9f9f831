// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace plumbline {

// Returns the CRC-32 of PNG, zip and zlib (polynomial 0xEDB88320, reflected). To continue over
// further bytes, pass the previous result as `crc`. By libdeflate. Cost: several GB/s.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace plumbline
