// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/recording_formats.h"

#include "tests/io/damaged_files.h"
#include "tests/support/mcap_writer.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string SmallFile(const std::string& packing, std::size_t chunk_bytes = 250) {
  McapWriter file(packing, chunk_bytes);
  file.Add("/a", "some.A", "protobuf", 5'000'000'007, "first");
  file.Add("/b", "some_msgs/msg/B", "cdr", 5'000'000'008, std::string(300, 'x'));
  file.Add("/a", "some.A", "protobuf", 6'000'000'000, "third");
  return file.Finish();
}

TEST(ReadMcap, GivesAllMessagesInOrder) {
  const ScratchFolder folder;
  for (const std::string packing : {"", "lz4", "zstd", "no chunks"}) {
    const bool chunks = packing != "no chunks";
    const auto path = folder.Write("x.mcap", chunks ? SmallFile(packing) : SmallFile("", 0));
    const ReadMessages all = ReadAll(ReadMcap, path);
    EXPECT_THAT(all.topics, ElementsAre("/a", "/b", "/a"));
    EXPECT_THAT(all.texts, ElementsAre("first", std::string(300, 'x'), "third"));
    ASSERT_EQ(all.file->channels().size(), 2U);
    EXPECT_EQ(all.file->channels()[1].type, "some_msgs/msg/B");
    EXPECT_EQ(all.file->channels()[1].encoding, "cdr");
    EXPECT_EQ(all.places[0].logged_ns, 5'000'000'007);
    for (const std::size_t i : {2, 0, 1}) {
      const auto again = all.file->Message(all.places[i]);
      ASSERT_TRUE(again);
      EXPECT_EQ(std::string(again->begin(), again->end()), all.texts[i]);
    }
  }
}

TEST(ReadMcap, NoticesEveryCut) {
  const ScratchFolder folder;
  ExpectEveryCutToShow(ReadMcap, folder, "cut.mcap", SmallFile("zstd"), 3);
  ExpectEveryCutToShow(ReadMcap, folder, "cut.mcap", SmallFile("", 0), 3);
}

// All of it is under a checksum but for the magic, the last records and what is not used.
TEST(ReadMcap, NoticesEveryChangedByteOfTheData) {
  const ScratchFolder folder;
  for (const std::string packing : {"", "lz4", "zstd"}) {
    const std::string bytes = SmallFile(packing);
    const std::string data = bytes.substr(0, bytes.size() - 60);
    const auto read = [&](const std::filesystem::path& path, const MessageSink& sink) {
      folder.Write("whole.mcap", Contents(path) + bytes.substr(data.size()));
      return ReadMcap(folder / "whole.mcap", sink);
    };
    EXPECT_EQ(ChangeBytes(read, folder, "changed.mcap", data, 1), static_cast<int>(data.size()));
  }
}

TEST(ReadMcap, SaysWhatIsWrong) {
  const ScratchFolder folder;
  const auto message = [&](const std::string& bytes) {
    const auto path = folder.Write("x.mcap", bytes);
    return MessageOf([&] { ReadAll(ReadMcap, path); });
  };
  const std::string good = SmallFile("");
  EXPECT_THAT(message("something else"), HasSubstr("expected an MCAP file"));
  EXPECT_THAT(message(good.substr(0, good.size() - 1)),
              HasSubstr("was not closed (mcap recover completes it)"));
  EXPECT_THAT(message(SmallFile("bz2")), HasSubstr("found 'bz2'"));
}

}  // namespace
}  // namespace plumbline
