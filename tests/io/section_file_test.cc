// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/section_file.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/base/random.h"

#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

std::string Noise(std::size_t size) {
  Rng rng(1);
  std::string noise;
  while (noise.size() < size) noise += static_cast<char>(rng.Next());
  return noise;
}

// Text that packs to about a third.
std::string Numbers() {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += std::to_string(i * i) + ' ';
  return text;
}

std::filesystem::path WriteThree(const ScratchFolder& folder) {
  SectionWriter file(folder / "s", "head");
  file.Write(7, Numbers());
  file.Write(8, Noise(1000));
  file.Write(9, {});
  file.Commit();
  return folder / "s";
}

TEST(SectionFile, GivesBackWhatWasWritten) {
  const ScratchFolder folder;
  SectionReader file(WriteThree(folder), 4);
  EXPECT_EQ(file.preamble(), "head");
  SectionReader::Section section = file.Next();
  EXPECT_EQ(section.kind, 7U);
  EXPECT_EQ(section.contents, Numbers());
  section = file.Next();
  EXPECT_EQ(section.kind, 8U);
  EXPECT_EQ(section.contents, Noise(1000));
  section = file.Next();
  EXPECT_EQ(section.kind, 9U);
  EXPECT_EQ(section.contents, "");
  EXPECT_EQ(file.remaining(), 0U);
  EXPECT_EQ(MessageOf([&] { file.Next(); }), file.source() + ": ends early");
}

TEST(SectionFile, TellsTheVersionInItsPreamble) {
  const ScratchFolder folder;
  const std::string preamble = VersionedPreamble("PLBTEST\n", 258);
  EXPECT_EQ(preamble, std::string("PLBTEST\n\x02\x01\0\0", kVersionedPreambleBytes));
  const SectionReader file(folder.Write("whole", preamble + "more"), kVersionedPreambleBytes);
  EXPECT_EQ(VersionOf(file, "PLBTEST\n"), 258U);
  EXPECT_EQ(VersionOf(file, "PLBOTHER"), std::nullopt);
  const SectionReader cut(folder.Write("cut", preamble.substr(0, 10)), kVersionedPreambleBytes);
  EXPECT_EQ(MessageOf([&] { VersionOf(cut, "PLBTEST\n"); }), cut.source() + ": ends early");
}

TEST(SectionFile, PacksWhatCanBePacked) {
  const ScratchFolder folder;
  EXPECT_LT(std::filesystem::file_size(WriteThree(folder)),
            4 + 3 * 32 + Numbers().size() / 2 + 1000);
}

// A gigabyte of zeros would be a few kilobytes: so much is left as it is, so that a small file
// cannot ask for it.
TEST(SectionFile, BoundsHowMuchASectionCanGrow) {
  const ScratchFolder folder;
  const std::string zeros(4'000'000, '\0');
  {
    SectionWriter file(folder / "s", "");
    file.Write(1, zeros);
    file.Commit();
  }
  EXPECT_GT(std::filesystem::file_size(folder / "s"), zeros.size() / 250);
  SectionReader file(folder / "s", 0);
  EXPECT_EQ(file.Next().contents, zeros);
  ByteWriter header;
  header(std::uint32_t{1});
  header(std::uint32_t{1});
  header(std::uint64_t{1});
  header(std::uint64_t{1} << 30);
  const std::string packed = "x";
  const auto crc = [](const std::string& text) {
    return Crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  header(crc(packed));
  header(crc(header.bytes()));
  SectionReader forged(folder.Write("forged", header.bytes() + packed), 0);
  EXPECT_THAT(MessageOf([&] { forged.Next(); }), HasSubstr("as it is or packed by zstd"));
}

TEST(SectionFile, NoticesCutsAndChangedBytes) {
  const ScratchFolder folder;
  const std::string whole = Contents(WriteThree(folder));
  const auto message = [&](const std::string& contents) {
    const auto path = folder.Write("x", contents);
    return MessageOf([&] {
      SectionReader file(path, 4);
      for (int i = 0; i < 3; ++i) file.Next();
    });
  };
  EXPECT_EQ(message(whole), "no error");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    EXPECT_THAT(message(whole.substr(0, length)), HasSubstr("ends early")) << length;
  }
  for (std::size_t at = 4; at < whole.size(); at += 7) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_THAT(message(changed), HasSubstr("damaged (wrong checksum)")) << at;
  }
}

TEST(SectionFile, LeavesNothingWithoutCommit) {
  const ScratchFolder folder;
  {
    SectionWriter file(folder / "s", "head");
    file.Write(1, "contents");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THAT(MessageOf([&] { SectionReader(folder / "s", 4); }), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf([&] { SectionReader(folder.path(), 4); }), HasSubstr("expected a file"));
}

}  // namespace
}  // namespace plumbline
