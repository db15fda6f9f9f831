// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/byte_format.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/error.h"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

ByteReader ReaderOf(const std::string& bytes) {
  return {{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "test"};
}

TEST(ImageBytes, HaveEveryPixel) {
  GrayImage image(3, 2, 7);
  image.at(2, 1) = 200;
  ByteWriter writer;
  Transfer(writer, image);
  ByteReader reader = ReaderOf(writer.bytes());
  GrayImage back;
  Transfer(reader, back);
  EXPECT_EQ(reader.remaining(), 0U);
  ASSERT_EQ(back.width(), 3);
  ASSERT_EQ(back.height(), 2);
  EXPECT_EQ(back.at(2, 1), 200);
  EXPECT_EQ(back.at(1, 1), 7);
}

TEST(ImageBytes, ThatAreFewerThanTheSizeSaysAreRefused) {
  for (const auto& [width, height] :
       {std::pair{3, 2}, {-3, -2}, {1 << 30, 1 << 30}, {-1, 5}, {0, -1}}) {
    ByteWriter writer;
    writer(std::int32_t{width});
    writer(std::int32_t{height});
    writer(std::uint8_t{1});
    ByteReader reader = ReaderOf(writer.bytes());
    GrayImage image;
    EXPECT_THROW(Transfer(reader, image), InputError) << width << " " << height;
  }
}

}  // namespace
}  // namespace plumbline
