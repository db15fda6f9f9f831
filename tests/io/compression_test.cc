// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/compression.h"

#include "tests/support/bag_writer.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

namespace plumbline {
namespace compression_test {

using testing::HasSubstr;

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Some hundred kilobytes: more than an unpacker gives in one step.
std::string Contents() {
  std::string text;
  for (int i = 0; i < 40000; ++i) text += std::to_string(i * i) + ' ';
  return text;
}

std::string Packed(const std::string& contents, Compression compression) {
  if (compression == Compression::kBzip2) return PackedForBag(contents, "bz2");
  if (compression == Compression::kLz4) return PackedForBag(contents, "lz4");
  if (compression == Compression::kNone) return contents;
  std::string packed(ZSTD_compressBound(contents.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), contents.data(), contents.size(), 1));
  return packed;
}

class Compressions : public testing::TestWithParam<Compression> {};

TEST_P(Compressions, GiveBackWhatWasPacked) {
  for (const std::string& contents : {Contents(), std::string("x"), std::string()}) {
    const auto bytes =
        Decompress(GetParam(), BytesOf(Packed(contents, GetParam())), contents.size());
    ASSERT_TRUE(bytes) << bytes.error();
    EXPECT_EQ(std::string(bytes->begin(), bytes->end()), contents);
  }
}

TEST_P(Compressions, SaySizesThatAreNotTrue) {
  const std::string contents = Contents();
  const std::string packed = Packed(contents, GetParam());
  const auto more = Decompress(GetParam(), BytesOf(packed), contents.size() - 1);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error(), HasSubstr("found more"));
  const auto fewer = Decompress(GetParam(), BytesOf(packed), contents.size() + 1);
  ASSERT_FALSE(fewer);
  EXPECT_THAT(fewer.error(), HasSubstr("found fewer"));
  // A size that nobody has the memory for asks for none.
  EXPECT_FALSE(Decompress(GetParam(), BytesOf(packed), std::uint64_t{1} << 60));
}

TEST_P(Compressions, NoticeDataThatEndEarly) {
  const std::string contents = Contents();
  const std::string packed = Packed(contents, GetParam());
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{3}, packed.size() / 2, packed.size() - 1}) {
    EXPECT_FALSE(Decompress(GetParam(), BytesOf(packed.substr(0, size)), contents.size())) << size;
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         Compressions,
                         testing::Values(Compression::kNone,
                                         Compression::kBzip2,
                                         Compression::kLz4,
                                         Compression::kZstd));

TEST(Decompress, NoticesDamage) {
  const std::string contents = Contents();
  std::string packed = Packed(contents, Compression::kBzip2);
  packed[packed.size() / 2] ^= 1;
  const auto bytes = Decompress(Compression::kBzip2, BytesOf(packed), contents.size());
  ASSERT_FALSE(bytes);
  EXPECT_THAT(bytes.error(), HasSubstr("damage"));
}

}  // namespace compression_test
}  // namespace plumbline
