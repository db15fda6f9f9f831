// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/chunk_file.h"

#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

std::string TextOf(const Expected<std::vector<std::uint8_t>, std::string>& bytes) {
  return bytes ? std::string(bytes->begin(), bytes->end()) : bytes.error();
}

TEST(ChunkFile, FindsMessagesInItsParts) {
  const ScratchFolder folder;
  ChunkFile file(folder.Write("x", "0123456789"));
  EXPECT_EQ(file.size(), 10U);
  file.AddChannel({"/a", "some.A", "protobuf"});
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(file.AddChunk(i, 3, Compression::kNone, 3), i);
  }
  // More parts than are kept, there and back again.
  for (const std::uint32_t i : {0U, 5U, 7U, 1U, 2U, 3U, 5U, 0U}) {
    const char first = static_cast<char>('0' + i);
    EXPECT_EQ(TextOf(file.Message({0, i, 1, 2, 0})),
              std::string({static_cast<char>(first + 1), static_cast<char>(first + 2)}));
  }
  EXPECT_EQ(TextOf(file.Message({0, 0, 2, 2, 0})), "the file has changed");
}

TEST(ChunkFile, SaysWhereAFileEnds) {
  const ScratchFolder folder;
  ChunkFile file(folder.Write("x", "0123456789"));
  EXPECT_THAT(MessageOf([&] { file.Bytes(8, 3); }),
              HasSubstr("x: byte 8: expected 3 bytes, but the file ends at 10"));
  EXPECT_THAT(MessageOf([&] { file.Bytes(11, 0); }), HasSubstr("byte 11"));
  EXPECT_THAT(MessageOf([&] { file.AddChunk(0, 3, Compression::kLz4, kLargestChunk + 1); }),
              HasSubstr("expected at most"));
  file.AddChannel({"/a", "some.A", "protobuf"});
  const std::uint32_t beyond = file.AddChunk(8, 5, Compression::kNone, 5);
  EXPECT_THAT(TextOf(file.Message({0, beyond, 0, 1, 0})), HasSubstr("but the file ends at 10"));
  EXPECT_THAT(MessageOf([&] { ChunkFile missing(folder / "y"); }), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf([&] { ChunkFile other(folder.path()); }), HasSubstr("found a folder"));
}

}  // namespace
}  // namespace plumbline
