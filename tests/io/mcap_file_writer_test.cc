// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/mcap_file_writer.h"

#include "plumbline/base/error.h"
#include "plumbline/io/recordings/recording_formats.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Row = std::tuple<std::string, std::int64_t, std::string>;  // topic, time, message

std::vector<Row> RowsOf(const std::filesystem::path& path) {
  std::vector<Row> rows;
  const auto take = [&](const Channel& channel, const StoredMessage& where, auto bytes) {
    rows.emplace_back(channel.topic, where.logged_ns, std::string(bytes.begin(), bytes.end()));
  };
  ReadMcap(path, take);
  return rows;
}

// Our reader compares all checksums.
TEST(McapFileWriter, WhatIsWrittenIsRead) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "a.mcap";
  std::vector<Row> rows;
  {
    McapFileWriter file(path);
    for (const char* topic : {"/a", "/b"}) {
      file.AddChannel({topic, "protobuf", "foxglove.PoseInFrame", "protobuf", "schema"});
    }
    for (int i = 0; i < 3000; ++i) {
      const std::string message(static_cast<std::size_t>(i), static_cast<char>('a' + i % 26));
      rows.emplace_back(i % 3 == 0 ? "/a" : "/b", 1'000'000'000LL + i, message);
      file.Write(i % 3 == 0 ? 0 : 1, 1'000'000'000LL + i, message);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(folder / "a.mcap.part"));
    file.Close();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap.part"));
  EXPECT_EQ(RowsOf(path), rows);
}

TEST(McapFileWriter, FilesBeginAlike) {
  const ScratchFolder folder;
  McapFileWriter(folder / "a.mcap").Close();
  EXPECT_THAT(plumbline::Contents(folder / "a.mcap"),
              testing::StartsWith(McapFileWriter::Beginning()));
  EXPECT_THAT(McapFileWriter::Beginning(), testing::HasSubstr("plumbline"));
}

TEST(McapFileWriter, AFileWithoutMessagesIsOne) {
  const ScratchFolder folder;
  McapFileWriter file(folder / "a.mcap");
  file.AddChannel({"/a", "protobuf", "x.Y", "protobuf", ""});
  file.Close();
  EXPECT_TRUE(RowsOf(folder / "a.mcap").empty());
}

TEST(McapFileWriter, ReplacesNothingWhereNothingWasWritten) {
  const ScratchFolder folder;
  const std::string earlier = McapFileWriter::Beginning() + "earlier";
  folder.Write("a.mcap", earlier);
  McapFileWriter(folder / "a.mcap").AddChannel({"/a", "protobuf", "x.Y", "protobuf", ""});
  EXPECT_EQ(plumbline::Contents(folder / "a.mcap"), earlier);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap.part"));
}

TEST(McapFileWriter, AFolderThatIsNotThereIsBadInput) {
  EXPECT_THROW(McapFileWriter("/no/such/folder/a.mcap"), InputError);
}

TEST(McapFileWriter, SetsAsideWhatWasNotCompleted) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "a.mcap";
  EXPECT_FALSE(McapFileWriter::SetPartAside(path));
  const std::string left = McapFileWriter::Beginning() + "messages";
  folder.Write("a.mcap.part", left);
  folder.Write("a.mcap.part-1", "mine");
  McapFileWriter(path).Close();
  EXPECT_EQ(plumbline::Contents(folder / "a.mcap.part-1"), "mine");
  EXPECT_EQ(plumbline::Contents(folder / "a.mcap.part-2"), left);
  EXPECT_TRUE(RowsOf(path).empty());
  folder.Write("a.mcap.part", "");  // of a program that died at once
  EXPECT_THAT(McapFileWriter::SetPartAside(path).value_or(""),
              testing::StartsWith(path.string() + ": an earlier run did not complete it; "));
  EXPECT_TRUE(std::filesystem::exists(folder / "a.mcap.part-3"));
}

TEST(McapFileWriter, RefusesWhatIsNotItsOwnInThePlaceOfThePart) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "a.mcap", part = folder / "a.mcap.part";
  const auto refused = [&](const std::string& found) {
    EXPECT_THAT(MessageOf([&] { McapFileWriter file(path); }),
                testing::StartsWith(part.string() +
                                    ": expected nothing, or a recording that was "
                                    "not completed, found " +
                                    found + "; move it"));
  };
  folder.Write("a.mcap.part", "mine");
  refused("another file");
  EXPECT_EQ(plumbline::Contents(part), "mine");
  std::filesystem::remove(part);
  const auto other = folder.Write("other.mcap", McapFileWriter::Beginning());
  std::filesystem::create_symlink(other, part);
  refused("a link");
  EXPECT_EQ(plumbline::Contents(other), McapFileWriter::Beginning());
  std::filesystem::remove(part);
  std::filesystem::create_symlink(folder / "nothing", part);
  refused("a link");
  EXPECT_FALSE(std::filesystem::exists(folder / "nothing"));
  std::filesystem::remove(part);
  std::filesystem::create_directory(part);
  refused("a folder");
}

TEST(McapFileWriter, IsForOneProgramAtATime) {
  const ScratchFolder folder;
  McapFileWriter file(folder / "a.mcap");
  EXPECT_THAT(MessageOf([&] { McapFileWriter::SetPartAside(folder / "a.mcap"); }),
              testing::HasSubstr("another run is writing this file"));
  file.Close();
  EXPECT_EQ(MessageOf([&] { McapFileWriter::SetPartAside(folder / "a.mcap"); }), "no error");
}

}  // namespace
}  // namespace plumbline
