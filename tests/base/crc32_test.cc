// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/crc32.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<std::uint8_t> Bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Crc32, KnownValues) {
  EXPECT_EQ(Crc32(Bytes("")), 0U);
  EXPECT_EQ(Crc32(Bytes("123456789")), 0xCBF43926U);  // the check value of the standard
  EXPECT_EQ(Crc32(Bytes("IEND")), 0xAE426082U);       // the end of every PNG file
}

TEST(Crc32, ContinuesOverPieces) {
  const std::vector<std::uint8_t> bytes = Bytes("a longer text, cut anywhere at all, 0123456789");
  const std::span<const std::uint8_t> all(bytes);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    EXPECT_EQ(Crc32(all.subspan(cut), Crc32(all.first(cut))), Crc32(all)) << cut;
  }
}

}  // namespace
}  // namespace plumbline
