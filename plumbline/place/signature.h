// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumbline {

// Half of the bits of a descriptor: the most distinctive ones, beginning with the highest bit of
// the first word. The first bits are also hardly correlated, so that they divide features evenly.
// The selection was measured once (docs/methods/places.md).
using Signature = std::array<std::uint32_t, 4>;
inline constexpr int kSignatureBits = 128;

// Return the signature of a point's descriptor (ORB), and of a line's (LBD). Cost: a tenth of a
// microsecond.
Signature PointSignature(const Descriptor& descriptor);
Signature LineSignature(const Descriptor& descriptor);

// Returns bit `index` of a signature, counted from the first.
inline bool BitOf(const Signature& signature, int index) {
  const auto bit = static_cast<unsigned>(index);
  return (signature[bit / 32] >> (31 - bit % 32) & 1U) != 0;
}

// Returns the number of differing bits.
inline int HammingDistance(const Signature& a, const Signature& b) {
  const auto pair = [](std::uint32_t high, std::uint32_t low) {
    return std::uint64_t{high} << 32U | low;
  };
  return CountBits(std::array{pair(a[0] ^ b[0], a[1] ^ b[1]), pair(a[2] ^ b[2], a[3] ^ b[3])});
}

}  // namespace plumbline
