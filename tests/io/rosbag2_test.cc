// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/recording_formats.h"

#include "tests/io/damaged_files.h"
#include "tests/support/mcap_writer.h"
#include "tests/support/rosbag2_writer.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace rosbag2_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kImage = "sensor_msgs/msg/Image";

std::filesystem::path WriteDb3(const ScratchFolder& folder,
                               const std::string& name,
                               const std::string& topic,
                               const std::string& message) {
  Rosbag2Writer(folder / name).Add(topic, kImage, 1, message);
  return folder / name;
}

ReadMessages Read(const std::vector<std::filesystem::path>& files) {
  const auto read = [&](const auto& path, const auto& sink) {
    return ReadRosbag2(path, files, sink);
  };
  return ReadAll(read, files[0].parent_path());
}

std::vector<std::string> Again(const ReadMessages& all) {
  std::vector<std::string> texts;
  for (const StoredMessage& place : all.places) {
    const auto bytes = all.file->Message(place);
    texts.push_back(bytes ? std::string(bytes->begin(), bytes->end()) : bytes.error());
  }
  return texts;
}

TEST(ReadRosbag2, JoinsFilesOfAllKinds) {
  const ScratchFolder folder;
  const auto first = WriteDb3(folder, "x_0.db3", "/b", "one");
  PackFile(WriteDb3(folder, "x_1.db3", "/a", "two"));
  McapWriter mcap("zstd");
  mcap.Add("/a", kImage, "cdr", 3, "three");
  const auto third = folder.Write("x_2.mcap", mcap.Finish());
  PackFile(folder.Write("x_3.mcap", Contents(third)));
  const ReadMessages all = Read({first, folder / "x_1.db3.zstd", third, folder / "x_3.mcap.zstd"});
  EXPECT_THAT(all.topics, ElementsAre("/b", "/a", "/a", "/a"));
  EXPECT_THAT(all.texts, ElementsAre("one", "two", "three", "three"));
  EXPECT_THAT(Again(all), ElementsAre("one", "two", "three", "three"));
  EXPECT_THAT(all.file->channels(), SizeIs(2));
  EXPECT_THAT(all.file->notes(), IsEmpty());
}

TEST(ReadRosbag2, UnpacksMessagesThatWerePackedOneByOne) {
  const ScratchFolder folder;
  const std::string message("\0\1\0\0 a message", 14);
  const auto file = WriteDb3(folder, "x.db3", "/a", PackedByZstd(message));
  const ReadMessages all = Read({file});
  EXPECT_THAT(Again(all), ElementsAre(message));
  const Channel channel = all.file->channels()[0];
  const auto stored = all.file->StoredBytes(all.places[0]);
  ASSERT_TRUE(stored);
  const auto unpacked = UnpackedMessage(channel, *stored);
  ASSERT_TRUE(unpacked.has_value() && *unpacked);
  EXPECT_EQ(std::string((*unpacked)->begin(), (*unpacked)->end()), message);
  EXPECT_FALSE(UnpackedMessage({"/a", kImage, "ros1"}, *stored));
  std::vector<std::uint8_t> cut(stored->begin(), stored->end() - 3);
  EXPECT_FALSE(*UnpackedMessage(channel, cut));
}

TEST(ReadRosbag2, ReadsWhatIsThereOfDamagedFiles) {
  const ScratchFolder folder;
  const auto first = WriteDb3(folder, "x_0.db3", "/a", "one");
  const auto second = folder.Write("x_1.db3", "damaged from the first byte on");
  McapWriter mcap("", 250);
  for (const char letter : {'a', 'b', 'c'})
    mcap.Add("/a", kImage, "cdr", 3, std::string(300, letter));
  const std::string whole = mcap.Finish();
  const auto third = folder.Write("x_2.mcap", whole.substr(0, whole.size() - 300));
  const ReadMessages all = Read({first, second, third, folder / "x_3.db3"});
  EXPECT_THAT(all.texts, ElementsAre("one", std::string(300, 'a'), std::string(300, 'b')));
  EXPECT_EQ(Again(all), all.texts);
  EXPECT_THAT(all.file->notes(),
              ElementsAre(HasSubstr("x_1.db3: expected the tables topics and messages"),
                          testing::AllOf(HasSubstr("x_2.mcap: byte "),
                                         HasSubstr("what comes before is read")),
                          HasSubstr("x_3.db3: no such file; the file is left out")));
  EXPECT_THAT(MessageOf([&] { Read({second, folder / "x_3.db3"}); }), HasSubstr("x_1.db3: "));
}

TEST(ReadRosbag2, ReadsTheBeginningOfAPackedFileThatWasCutShort) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "x.db3");
    std::string noise;
    std::uint32_t state = 1;
    for (int i = 0; i < 100; ++i) {
      for (int k = 0; k < 6000; ++k) noise += static_cast<char>((state = state * 69069 + 1) >> 24U);
      bag.Add("/a", kImage, i, noise.substr(noise.size() - 6000));
    }
  }
  PackFile(folder / "x.db3");
  const std::string packed = Contents(folder / "x.db3.zstd");
  folder.Write("x.db3.zstd", packed.substr(0, packed.size() * 2 / 3));
  const ReadMessages all = Read({folder / "x.db3.zstd"});
  EXPECT_GT(all.texts.size(), 30U);
  EXPECT_LT(all.texts.size(), 70U);
  EXPECT_EQ(Again(all), all.texts);
  EXPECT_THAT(all.file->notes(),
              ElementsAre(HasSubstr("is damaged or cut short"),
                          HasSubstr("x.db3.zstd: the packed data ends early")));
}

TEST(ReadRosbag2, SaysThatAPackedFileIsDamaged) {
  const ScratchFolder folder;
  WriteDb3(folder, "x.db3", "/a", "one");
  PackFile(folder / "x.db3");
  const std::string packed = Contents(folder / "x.db3.zstd");
  const auto damaged = folder.Write("y.db3.zstd", packed.substr(0, 6) + std::string(99, '?'));
  EXPECT_EQ(MessageOf([&] { Read({damaged}); }), damaged.string() + ": the packed data is damaged");
  const auto cut = folder.Write("z.db3.zstd", packed.substr(0, 6));
  EXPECT_EQ(MessageOf([&] { Read({cut}); }), cut.string() + ": the packed data ends early");
  const auto other = folder.Write("a.db3.zstd", "no packed data at all");
  EXPECT_EQ(MessageOf([&] { Read({other}); }), other.string() + ": the packed data is damaged");
  const auto empty = folder.Write("b.db3.zstd", "");
  EXPECT_EQ(MessageOf([&] { Read({empty}); }), empty.string() + ": the packed data ends early");
}

}  // namespace rosbag2_test
}  // namespace plumbline
