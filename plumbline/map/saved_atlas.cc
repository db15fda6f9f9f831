// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/saved_atlas.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace plumbline {
namespace {

// Returns a number that differs where the bytes differ, except with a chance of about 2^-64, and
// that differs for other seeds. It is FNV-1a, mixed at the end as splitmix64 does. It does not
// withstand adversaries.
std::uint64_t HashOf(std::string_view bytes, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325U ^ (seed * 0x9e3779b97f4a7c15U);
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  hash = (hash ^ (hash >> 30U)) * 0xbf58476d1ce4e5b9U;
  hash = (hash ^ (hash >> 27U)) * 0x94d049bb133111ebU;
  return hash ^ (hash >> 31U);
}

}  // namespace

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
    const std::uint64_t hash = HashOf(contents, half);
    for (std::size_t i = 0; i < 8; ++i) {
      uuid.bytes[8 * half + i] = static_cast<std::uint8_t>(hash >> (8 * i));
    }
  }
  uuid.bytes[6] = static_cast<std::uint8_t>((uuid.bytes[6] & 0x0FU) | 0x80U);  // version 8
  uuid.bytes[8] = static_cast<std::uint8_t>((uuid.bytes[8] & 0x3FU) | 0x80U);  // variant of the RFC
  return uuid;
}

}  // namespace plumbline
