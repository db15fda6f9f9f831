// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/crc32.h"

#include <libdeflate.h>

namespace plumbline {

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  // For no bytes a null pointer, which a span may have, would mean the first value of a sum.
  return bytes.empty() ? crc : libdeflate_crc32(crc, bytes.data(), bytes.size());
}

}  // namespace plumbline
