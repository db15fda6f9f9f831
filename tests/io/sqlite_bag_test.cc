// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/recording_formats.h"

#include "tests/io/damaged_files.h"
#include "tests/support/rosbag2_writer.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace sqlite_bag_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kImage = "sensor_msgs/msg/Image";

ReadMessages ReadSqlite(const std::filesystem::path& path) {
  return ReadAll([](const auto& file, const auto& sink) { return ReadSqliteBag(file, sink); },
                 path);
}

void AddThree(Rosbag2Writer& bag) {
  bag.Add("/a", kImage, 5'000'000'007, "first");
  bag.Add("/scan", "sensor_msgs/msg/LaserScan", 5'000'000'008, "another type");
  bag.Add("/b", "sensor_msgs/msg/CameraInfo", 5'000'000'009, std::string(9000, 'x'));
  bag.Add("/a", kImage, 6'000'000'000, "third");
}

TEST(ReadSqliteBag, GivesMessagesOfKnownTypesInOrder) {
  for (const auto version : {Rosbag2Writer::Version::kFoxy, Rosbag2Writer::Version::kJazzy}) {
    const ScratchFolder folder;
    const auto path = folder / "a file? of 100%.db3";
    {
      Rosbag2Writer bag(path, version);
      AddThree(bag);
    }
    const std::string before = Contents(path);
    const ReadMessages all = ReadSqlite(path);
    EXPECT_THAT(all.topics, ElementsAre("/a", "/b", "/a"));
    EXPECT_THAT(all.texts, ElementsAre("first", std::string(9000, 'x'), "third"));
    ASSERT_THAT(all.file->channels(), SizeIs(3));
    EXPECT_EQ(all.file->channels()[1].type, "sensor_msgs/msg/LaserScan");
    EXPECT_EQ(all.file->channels()[0].encoding, "cdr");
    EXPECT_EQ(all.places[0].logged_ns, 5'000'000'007);
    EXPECT_THAT(all.file->notes(), IsEmpty());
    for (const std::size_t i : {2, 0, 1}) {
      const auto again = all.file->Message(all.places[i]);
      ASSERT_TRUE(again);
      EXPECT_EQ(std::string(again->begin(), again->end()), all.texts[i]);
    }
    EXPECT_EQ(Contents(path), before);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
}

TEST(ReadSqliteBag, ReadsAFileInAFolderThatNobodyMayWrite) {
  const ScratchFolder folder;
  { Rosbag2Writer(folder / "bag/x.db3").Add("/a", kImage, 1, "first"); }
  const auto all_may = std::filesystem::perms::owner_all;
  std::filesystem::permissions(
      folder / "bag", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THAT(ReadSqlite(folder / "bag/x.db3").texts, ElementsAre("first"));
  std::filesystem::permissions(folder / "bag", all_may);
}

// The recorder goes on meanwhile, and its files keep their bytes.
TEST(ReadSqliteBag, ReadsWhatARecorderHasWrittenSoFar) {
  const ScratchFolder folder;
  const auto path = folder / "x.db3";
  Rosbag2Writer bag(path);
  bag.Do("PRAGMA journal_mode=WAL");
  bag.Do("PRAGMA wal_autocheckpoint=0");
  AddThree(bag);
  const std::string before = Contents(path), journal = Contents(folder / "x.db3-wal");
  ASSERT_FALSE(journal.empty());
  const ReadMessages all = ReadSqlite(path);
  EXPECT_THAT(all.texts, SizeIs(3));
  EXPECT_THAT(all.file->notes(),
              ElementsAre(HasSubstr("x.db3-wal lies beside x.db3: it is being")));
  EXPECT_EQ(Contents(path), before);
  EXPECT_EQ(Contents(folder / "x.db3-wal"), journal);
  bag.Add("/a", kImage, 7'000'000'000, "fourth");
  bag.Do("PRAGMA wal_checkpoint(TRUNCATE)");
  EXPECT_TRUE(all.file->Message(all.places[2]));
  EXPECT_THAT(ReadSqlite(path).texts, SizeIs(4));
}

// A recorder that holds the lock with which it writes is not waited for, nor kept from writing.
TEST(ReadSqliteBag, NeitherLocksNorWaits) {
  const ScratchFolder folder;
  Rosbag2Writer bag(folder / "x.db3");
  bag.Do("PRAGMA journal_mode=MEMORY");
  AddThree(bag);
  bag.Do("BEGIN EXCLUSIVE");
  const ReadMessages all = ReadSqlite(folder / "x.db3");
  EXPECT_THAT(all.texts, SizeIs(3));
  bag.Add("/a", kImage, 7'000'000'000, "fourth");
  bag.Do("COMMIT");
  EXPECT_TRUE(all.file->Message(all.places[0]));
}

// A recorder was killed in the middle of a transaction, part of which is in the file.
TEST(ReadSqliteBag, PlaysBackAJournalThatWasLeftBehind) {
  const ScratchFolder folder;
  Rosbag2Writer bag(folder / "live/x.db3");
  AddThree(bag);
  bag.Do("PRAGMA cache_size=1");
  bag.Do("BEGIN");
  for (int i = 0; i < 200; ++i) bag.Add("/a", kImage, i, std::string(5000, 'y'));
  std::filesystem::create_directories(folder / "dead");
  for (const char* name : {"x.db3", "x.db3-journal"}) {
    std::filesystem::copy_file(folder / "live" / name, folder / "dead" / name);
  }
  const std::string before = Contents(folder / "dead/x.db3");
  const ReadMessages all = ReadSqlite(folder / "dead/x.db3");
  EXPECT_THAT(all.texts, ElementsAre("first", std::string(9000, 'x'), "third"));
  EXPECT_THAT(all.file->notes(), ElementsAre(HasSubstr("x.db3-journal lies beside x.db3")));
  EXPECT_EQ(Contents(folder / "dead/x.db3"), before);
  EXPECT_TRUE(std::filesystem::exists(folder / "dead/x.db3-journal"));
}

TEST(ReadSqliteBag, ReadsWhatIsThereOfAFileThatWasCutShort) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "whole.db3");
    for (int i = 0; i < 40; ++i) {
      bag.Add("/a", kImage, i, std::string(6000, static_cast<char>('A' + i)));
    }
  }
  const std::string bytes = Contents(folder / "whole.db3");
  std::size_t before = 40;
  for (const double share : {0.9, 0.5, 0.25}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    const ReadMessages all = ReadSqlite(folder.Write("cut.db3", bytes.substr(0, size)));
    const auto count = static_cast<double>(all.texts.size());
    EXPECT_LT(all.texts.size(), before);
    EXPECT_GE(count, 40 * share - 6);
    before = all.texts.size();
    for (std::size_t i = 0; i < all.texts.size(); ++i) {
      EXPECT_TRUE(all.texts[i] == std::string(6000, static_cast<char>('A' + i))) << i;
    }
    EXPECT_THAT(all.file->notes(),
                ElementsAre(HasSubstr("cut.db3 is damaged or cut short: " +
                                      std::to_string(all.texts.size()) + " messages")));
  }
}

// Behind a damaged page the messages go on.
TEST(ReadSqliteBag, LeavesOutDamagedPages) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "whole.db3");
    for (int i = 0; i < 400; ++i) bag.Add("/a", kImage, i, std::string(300, static_cast<char>(i)));
  }
  std::string bytes = Contents(folder / "whole.db3");
  const std::size_t page = 20 * 4096;
  bytes.replace(page, 4096, std::string(4096, '\xAA'));
  const ReadMessages all = ReadSqlite(folder.Write("x.db3", bytes));
  EXPECT_GT(all.texts.size(), 360U);
  EXPECT_LT(all.texts.size(), 400U);
  EXPECT_EQ(all.texts.back(), std::string(300, static_cast<char>(399)));
  EXPECT_THAT(all.file->notes(), ElementsAre(HasSubstr("is damaged or cut short")));
}

TEST(ReadSqliteBag, EveryChangedByteGivesMessagesOrOneLine) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "whole.db3");
    bag.Do("PRAGMA page_size=512");
    bag.Do("VACUUM");
    AddThree(bag);
  }
  const std::string bytes = Contents(folder / "whole.db3");
  const auto read = [](const auto& file, const auto& sink) { return ReadSqliteBag(file, sink); };
  ChangeBytes(read, folder, "changed.db3", bytes, 17);
  for (std::size_t size = 0; size < bytes.size(); size += 331) {
    const auto path = folder.Write("cut.db3", bytes.substr(0, size));
    const std::string message = MessageOf([&] { ReadAll(read, path); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(ReadSqliteBag, SaysWhatIsWrong) {
  const ScratchFolder folder;
  const auto message = [&](const std::filesystem::path& path) {
    return MessageOf([&] { ReadSqlite(path); });
  };
  EXPECT_THAT(message(folder / "none.db3"), HasSubstr("none.db3: no such file"));
  EXPECT_THAT(message(folder.Write("x.db3", "something else, which is long enough")),
              HasSubstr("x.db3: expected the tables topics and messages of a ROS 2 bag, found "
                        "another file"));
  EXPECT_THAT(message(folder.Write("empty.db3", "")), HasSubstr("found an empty file"));
  {
    Rosbag2Writer bag(folder / "long.db3");
    AddThree(bag);
  }
  const std::string whole = Contents(folder / "long.db3");
  for (const std::size_t size : {60, 600, 4096}) {
    EXPECT_THAT(
        message(folder.Write("cut.db3", whole.substr(0, size))),
        HasSubstr("cut.db3: expected the tables topics and messages of a ROS 2 bag, found a "
                  "file that ends early"))
        << size;
  }
  { Rosbag2Writer(folder / "other.db3").Do("DROP TABLE messages"); }
  EXPECT_THAT(message(folder / "other.db3"), HasSubstr("found an SQLite file without them"));
}

// A view in place of a table could ask for more than any machine has.
TEST(ReadSqliteBag, RunsNothingThatTheFileSays) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "x.db3");
    bag.Do("DROP TABLE messages");
    bag.Do(
        "CREATE VIEW messages AS WITH RECURSIVE n(rowid, topic_id, timestamp, data) AS (SELECT "
        "1, 1, 1, 'x' UNION ALL SELECT rowid + 1, 1, 1, 'x' FROM n) SELECT * FROM n");
  }
  EXPECT_THAT(MessageOf([&] { ReadSqlite(folder / "x.db3"); }), HasSubstr("x.db3: expected"));
}

}  // namespace sqlite_bag_test
}  // namespace plumbline
