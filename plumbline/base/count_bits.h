// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumbline {

// Returns the number of bits set in up to 31 words. Processors that we compile for need not have an
// instruction for it, and std::popcount then uses a table of bytes. Adding neighbouring fields of
// all words at once takes a third of that time.
template <std::size_t kWords>
int CountBits(const std::array<std::uint64_t, kWords>& words) {
  static_assert(kWords <= 31, "sums of bytes must fit into bytes");
  constexpr std::uint64_t kEverySecond = 0x5555555555555555, kPairs = 0x3333333333333333,
                          kNibbles = 0x0f0f0f0f0f0f0f0f, kBytes = 0x00ff00ff00ff00ff,
                          kSumToTheTop = 0x0001000100010001;
  std::uint64_t sums = 0;  // sum of the bits of each byte
  for (std::uint64_t word : words) {
    word -= word >> 1U & kEverySecond;
    word = (word & kPairs) + (word >> 2U & kPairs);
    sums += (word + (word >> 4U)) & kNibbles;
  }
  return static_cast<int>(((sums & kBytes) + (sums >> 8U & kBytes)) * kSumToTheTop >> 48U);
}

}  // namespace plumbline
