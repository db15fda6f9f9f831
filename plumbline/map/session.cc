// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/session.h"

#include "plumbline/base/content_hash.h"

#include <cstddef>

namespace plumbline {

std::string ToString(const Uuid& uuid) {
  static constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < uuid.bytes.size(); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
    text += kDigits[uuid.bytes[i] >> 4U];
    text += kDigits[uuid.bytes[i] & 15U];
  }
  return text;
}

Uuid UuidOf(const std::string& contents) {
  Uuid uuid;
  for (std::uint64_t half = 0; half < 2; ++half) {
    const std::uint64_t hash = ContentHash(contents, half);
    for (std::size_t i = 0; i < 8; ++i) {
      uuid.bytes[8 * half + i] = static_cast<std::uint8_t>(hash >> (8 * i));
    }
  }
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0FU) | 0x80U);  // version 8
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3FU) | 0x80U);  // variant of the RFC
  return uuid;
}

}  // namespace plumbline
