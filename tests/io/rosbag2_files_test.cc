// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/rosbag2_files.h"

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/mcap_writer.h"
#include "tests/support/rosbag2_writer.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace rosbag2_files_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kSecond = 1'000'000'000;

std::vector<std::string> NamesOf(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& file : FindRosbag2Files(folder).files) names.push_back(file.filename().string());
  return names;
}

TEST(FindRosbag2Files, TakesThoseOfTheMetadataInItsOrder) {
  const ScratchFolder folder;
  for (const char* name : {"b_0.db3", "b_1.db3.zstd", "b_2.db3", "c.mcap"}) folder.Write(name, "x");
  // With the folder's name before them, as old versions write them; unpacked and packed since.
  folder.Write("metadata.yaml",
               Rosbag2Metadata({"walk/b_2.db3.zstd", "walk/b_0.db3", "walk/b_1.db3", "b_9.db3"}));
  EXPECT_THAT(NamesOf(folder.path()), ElementsAre("b_2.db3", "b_0.db3", "b_1.db3.zstd"));
  EXPECT_THAT(FindRosbag2Files(folder.path()).notes,
              ElementsAre(HasSubstr("b_9.db3, which metadata.yaml lists, does not exist"),
                          HasSubstr("metadata.yaml does not list c.mcap: left out")));
}

TEST(FindRosbag2Files, SaysWhatTheMetadataHasWrong) {
  const ScratchFolder folder;
  folder.Write("b_0.db3", "x");
  folder.Write("metadata.yaml", Rosbag2Metadata({"b_0.db3", "b_0.db3.zstd"}));
  EXPECT_THAT(NamesOf(folder.path()), ElementsAre("b_0.db3"));
  EXPECT_THAT(FindRosbag2Files(folder.path()).notes,
              ElementsAre((folder / "b_0.db3").string() +
                          ": metadata.yaml lists it more than once; it counts once"));
  std::filesystem::remove(folder / "b_0.db3");
  EXPECT_THAT(MessageOf([&] { FindRosbag2Files(folder.path()); }),
              HasSubstr("found none: " + (folder / "b_0.db3").string() +
                        ", which metadata.yaml lists, does not exist"));
}

TEST(FindRosbag2Files, GoesByNamesWithoutMetadata) {
  const ScratchFolder folder;
  for (const char* name : {"b_10.db3", "b_9.db3", "b_9.db3.zstd", "b_9.db3-wal"}) {
    folder.Write(name, "x");
  }
  EXPECT_THAT(NamesOf(folder.path()), ElementsAre("b_9.db3", "b_10.db3"));
  EXPECT_THAT(FindRosbag2Files(folder.path()).notes,
              ElementsAre(HasSubstr("metadata.yaml does not exist: the files are read in the order "
                                    "of their names: b_9.db3, b_10.db3")));
  for (const char* damaged :
       {"",
        "x: [\n",
        "rosbag2_bagfile_information: 3\n",
        "rosbag2_bagfile_information:\n  relative_file_paths: [gone.db3]\n"}) {
    folder.Write("metadata.yaml", damaged);
    EXPECT_THAT(NamesOf(folder.path()), ElementsAre("b_9.db3", "b_10.db3")) << damaged;
    EXPECT_THAT(FindRosbag2Files(folder.path()).notes, ElementsAre(HasSubstr("metadata.yaml")));
  }
  folder.Write("other.db3", "x");
  EXPECT_THAT(MessageOf([&] { FindRosbag2Files(folder.path()); }),
              HasSubstr("expected the files of one recording, found b_9.db3 and other.db3"));
}

TestImage Gray(std::int64_t stamp_ns, char value) {
  return {stamp_ns, "mono8", 8, 6, 8, std::string(48, value)};
}

void Add(Rosbag2Writer& bag, const std::string& topic, const TestImage& image) {
  bag.Add(
      topic, "sensor_msgs/msg/Image", image.stamp_ns + 7, RawImageMessage(Dialect::kCdr, image));
}

void AddInfo(Rosbag2Writer& bag) {
  bag.Add(
      "/c/camera_info", "sensor_msgs/msg/CameraInfo", 1, CalibrationMessageOf(Dialect::kCdr, {}));
}

// Three images in two files.
void WriteBag(const ScratchFolder& folder) {
  Rosbag2Writer first(folder / "walk/walk_0.db3");
  AddInfo(first);
  Add(first, "/c/image", Gray(kSecond, 'a'));
  Rosbag2Writer second(folder / "walk/walk_1.db3");
  Add(second, "/c/image", Gray(2 * kSecond, 'b'));
  Add(second, "/c/image", Gray(3 * kSecond, 'c'));
}

TEST(Rosbag2, IsOpenedAsFolderAndAsFile) {
  const ScratchFolder folder;
  WriteBag(folder);
  folder.Write("walk/metadata.yaml", Rosbag2Metadata({"walk_0.db3", "walk_1.db3"}));
  const auto dataset = OpenDataset(folder / "walk");
  EXPECT_EQ(dataset->info().format, DatasetFormat::kRosbag2);
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(kSecond, 2 * kSecond, 3 * kSecond));
  EXPECT_THAT(dataset->info().notes, ElementsAre("topics: /c/image"));
  EXPECT_EQ(dataset->Read(0)->left.at(7, 5), 'a');
  EXPECT_EQ(dataset->Read(2)->left.at(7, 5), 'c');
  EXPECT_EQ(dataset->calibration().left.intrinsics().fx, 5);
  EXPECT_EQ(OpenDataset(folder / "walk/walk_0.db3")->size(), 1U);
  // A camera file in the folder wins over what the recording says.
  folder.Write("walk/camera.yaml", "size: [8, 6]\nintrinsics: [7, 7, 4, 3]\n");
  EXPECT_EQ(OpenDataset(folder / "walk")->calibration().left.intrinsics().fx, 7);
  std::filesystem::rename(folder / "walk/walk_0.db3", folder / "any name");
  EXPECT_EQ(FindFormat(folder / "any name"), DatasetFormat::kRosbag2);
}

TEST(Rosbag2, IsReadWithoutMetadataWithANote) {
  const ScratchFolder folder;
  WriteBag(folder);
  const auto dataset = OpenDataset(folder / "walk");
  EXPECT_EQ(dataset->size(), 3U);
  EXPECT_THAT(dataset->info().notes, Contains(HasSubstr("metadata.yaml does not exist")));
  // Beside other files, a recording is no recording of its own folder.
  folder.Write("walk/trajectory.txt", "");
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder / "walk"); }), HasSubstr("found none of them"));
}

TEST(Rosbag2, ReadsMcapAndPackedFilesOfAFolder) {
  const ScratchFolder folder;
  WriteBag(folder);
  PackFile(folder / "walk/walk_0.db3");
  McapWriter mcap;
  mcap.Add("/c/image",
           "sensor_msgs/msg/Image",
           "cdr",
           4 * kSecond,
           PackedByZstd(RawImageMessage(Dialect::kCdr, Gray(4 * kSecond, 'd'))));
  folder.Write("walk/walk_2.mcap", mcap.Finish());
  folder.Write("walk/metadata.yaml",
               Rosbag2Metadata({"walk_0.db3.zstd", "walk_1.db3", "walk_2.mcap"}));
  const auto dataset = OpenDataset(folder / "walk");
  ASSERT_EQ(dataset->size(), 4U);
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 'a');
  EXPECT_EQ(dataset->Read(3)->left.at(0, 0), 'd');
  EXPECT_EQ(OpenDataset(folder / "walk/walk_0.db3.zstd")->size(), 1U);
}

TEST(Rosbag2, LeavesOutBrokenMessages) {
  const ScratchFolder folder;
  {
    Rosbag2Writer bag(folder / "x.db3");
    AddInfo(bag);
    Add(bag, "/c/image", Gray(kSecond, 'a'));
    bag.Add("/c/image", "sensor_msgs/msg/Image", 2 * kSecond, std::string(100, '\0'));
  }
  const auto dataset = OpenDataset(folder / "x.db3");
  EXPECT_EQ(dataset->size(), 1U);
  EXPECT_THAT(dataset->info().notes,
              Contains("1 messages of /c/image are damaged and are left out"));
  { Rosbag2Writer(folder / "y.db3").Add("/c/image", "sensor_msgs/msg/Image", 2, "nothing"); }
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder / "y.db3"); }),
              HasSubstr("expected messages of sensor_msgs/msg/Image on /c/image"));
  { Rosbag2Writer(folder / "z.db3").Add("/imu", "sensor_msgs/msg/Imu", 2, "something"); }
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder / "z.db3"); }),
              HasSubstr("found sensor_msgs/msg/Imu"));
}

TEST(Rosbag2, SaysWhyNoImageIsFound) {
  const ScratchFolder folder;
  const auto message = [&](const std::string& name) {
    return MessageOf([&] { OpenDataset(folder / name); });
  };
  {
    Rosbag2Writer bag(folder / "x.db3");
    Add(bag, "/c/image", Gray(kSecond, 'a'));
    bag.Do("UPDATE messages SET topic_id = 99");
  }
  EXPECT_THAT(
      message("x.db3"),
      testing::EndsWith("found no message of the topics of images /c/image; " +
                        (folder / "x.db3").string() +
                        ": 1 messages have a topic_id that the table topics does not list"));
  McapWriter mcap;
  const std::string whole = mcap.Finish();
  folder.Write("walk/walk_0.mcap", whole.substr(0, 8) + std::string(200, '?'));
  folder.Write("walk/metadata.yaml", Rosbag2Metadata({"walk_0.mcap"}));
  EXPECT_THAT(message("walk"), HasSubstr("walk_0.mcap: byte 8: expected "));
  std::filesystem::create_symlink("round.db3", folder / "round.db3");
  EXPECT_THAT(message("round.db3"), HasSubstr("round.db3: cannot be read: Too many levels"));
}

}  // namespace rosbag2_files_test
}  // namespace plumbline
