// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/recording_formats.h"

#include "tests/io/damaged_files.h"
#include "tests/support/bag_writer.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Three messages on two topics, in two chunks.
std::string SmallBag(const std::string& packing) {
  BagWriter bag(packing, 250);
  bag.Add("/a", "some_msgs/A", 5'000'000'007, "first");
  bag.Add("/b", "some_msgs/B", 5'000'000'008, std::string(300, 'x'));
  bag.Add("/a", "some_msgs/A", 6'000'000'000, "third");
  return bag.Finish();
}

TEST(ReadBag, GivesAllMessagesInOrder) {
  const ScratchFolder folder;
  for (const std::string packing : {"none", "bz2", "lz4"}) {
    const auto path = folder.Write(packing + ".bag", SmallBag(packing));
    const ReadMessages all = ReadAll(ReadBag, path);
    EXPECT_THAT(all.topics, ElementsAre("/a", "/b", "/a"));
    EXPECT_THAT(all.texts, ElementsAre("first", std::string(300, 'x'), "third"));
    ASSERT_EQ(all.file->channels().size(), 2U);
    EXPECT_EQ(all.file->channels()[1].type, "some_msgs/B");
    EXPECT_EQ(all.file->channels()[1].encoding, "ros1");
    EXPECT_EQ(all.places[0].logged_ns, 5'000'000'007);
    EXPECT_NE(all.places[0].chunk, all.places[2].chunk);
    for (const std::size_t i : {2, 0, 1}) {
      const auto again = all.file->Message(all.places[i]);
      ASSERT_TRUE(again);
      EXPECT_EQ(std::string(again->begin(), again->end()), all.texts[i]);
    }
  }
}

TEST(ReadBag, NoticesEveryCut) {
  const ScratchFolder folder;
  for (const std::string packing : {"none", "bz2", "lz4"}) {
    ExpectEveryCutToShow(ReadBag, folder, "cut.bag", SmallBag(packing), 7);
  }
}

TEST(ReadBag, SurvivesEveryChangedByte) {
  const ScratchFolder folder;
  EXPECT_GT(ChangeBytes(ReadBag, folder, "changed.bag", SmallBag("none"), 11), 20);
  EXPECT_GT(ChangeBytes(ReadBag, folder, "changed.bag", SmallBag("bz2"), 11), 20);
  EXPECT_GT(ChangeBytes(ReadBag, folder, "changed.bag", SmallBag("lz4"), 11), 20);
}

TEST(ReadBag, SaysWhatIsWrong) {
  const ScratchFolder folder;
  const auto message = [&](const std::string& bytes) {
    const auto path = folder.Write("x.bag", bytes);
    return MessageOf([&] { ReadAll(ReadBag, path); });
  };
  const std::string good = SmallBag("none");
  EXPECT_THAT(message("#ROSBAG V1.2\n" + good.substr(13)),
              HasSubstr("expected a bag of version 2.0, found '#ROSBAG V1.2'"));
  EXPECT_THAT(message("something else"), HasSubstr("expected a ROS 1 bag"));
  const auto with = [&](const std::string& name, const std::string& from, const std::string& to) {
    std::string bytes = good;
    const std::size_t at = bytes.find(name + from);
    EXPECT_NE(at, std::string::npos) << name;
    bytes.replace(at + name.size(), from.size(), to);
    return message(bytes);
  };
  EXPECT_THAT(with("compression=", "none", "nine"), HasSubstr("found 'nine'"));
  EXPECT_THAT(with("chunk_count=", std::string("\2\0\0\0", 4), std::string("\3\0\0\0", 4)),
              HasSubstr("expected 3 chunks, found 2"));
  EXPECT_THAT(with("conn_count=", std::string("\2\0\0\0", 4), std::string("\5\0\0\0", 4)),
              HasSubstr("expected 5 connections in the index, found 2"));
  std::string open = good;
  open.replace(open.find("index_pos=") + 10, 8, std::string(8, '\0'));
  EXPECT_THAT(message(open), HasSubstr("was not closed (rosbag reindex completes it)"));
  EXPECT_THAT(MessageOf([&] { ReadAll(ReadBag, folder / "none.bag"); }), HasSubstr("no such file"));
}

}  // namespace
}  // namespace plumbline
