// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/euroc_frames.h"
#include "tests/e2e/program.h"
#include "tests/e2e/same_run.h"
#include "tests/support/bag_writer.h"
#include "tests/support/data_folder.h"
#include "tests/support/mcap_writer.h"
#include "tests/support/rosbag2_writer.h"
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace recording_test {

using testing::HasSubstr;

// With the damaged image of the sequence, of frame 163.
constexpr std::pair<std::size_t, std::size_t> kFrames = {155, 175};

// The topic of a EuRoC bag, and the message; of an image that cannot be decoded, its file.
struct Sent {
  std::string topic, type, message;
};

Sent AsRos(const EurocImage& image, Dialect dialect) {
  const bool ros2 = dialect == Dialect::kCdr;
  const std::string topic = "/cam" + std::to_string(image.camera) + "/image_raw";
  const std::string package = ros2 ? "sensor_msgs/msg/" : "sensor_msgs/";
  const auto width = static_cast<std::uint32_t>(image.width);
  const TestImage sent{image.stamp_ns,
                       image.readable ? "mono8" : "png",
                       width,
                       static_cast<std::uint32_t>(image.height),
                       width,
                       image.bytes};
  if (image.readable) return {topic, package + "Image", RawImageMessage(dialect, sent)};
  return {topic, package + "CompressedImage", CompressedImageMessage(dialect, sent)};
}

TEST(RunRecording, GivesTheBytesOfTheFolder) {
  const auto data = FindData("euroc/MH_01_easy_first250");
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  BagWriter bag("lz4");
  McapWriter mcap("zstd");
  // Two files, the second one packed.
  auto split = std::make_unique<Rosbag2Writer>(folder / "MH_01_db3/MH_01_0.db3");
  int damaged = 0, images = 0;
  ForEachEurocImage(*data, kFrames, [&](const EurocImage& image) {
    damaged += image.readable ? 0 : 1;
    const Sent ros1 = AsRos(image, Dialect::kRos1), ros2 = AsRos(image, Dialect::kCdr);
    bag.Add(ros1.topic, ros1.type, image.stamp_ns + 1000, ros1.message);
    mcap.Add(ros2.topic, ros2.type, "cdr", image.stamp_ns + 1000, ros2.message);
    if (++images == 21) split = std::make_unique<Rosbag2Writer>(folder / "MH_01_db3/MH_01_1.db3");
    split->Add(ros2.topic, ros2.type, image.stamp_ns + 1000, ros2.message);
  });
  EXPECT_EQ(damaged, 1);
  folder.Write("MH_01.bag", bag.Finish());
  folder.Write("MH_01.mcap", mcap.Finish());
  split.reset();
  PackFile(folder / "MH_01_db3/MH_01_1.db3");
  folder.Write("MH_01_db3/metadata.yaml", Rosbag2Metadata({"MH_01_0.db3", "MH_01_1.db3.zstd"}));
  const std::string camera = " --camera euroc --imu off --out ";
  const Outcome whole =
      RunProgram(folder,
                 "run " + Quoted(*data) + " --from " + std::to_string(kFrames.first) + " --to " +
                     std::to_string(kFrames.second) + camera + Quoted(folder / "folder"));
  ASSERT_EQ(whole.code, 0) << whole.err;
  for (const std::string name : {"MH_01.bag", "MH_01.mcap", "MH_01_db3"}) {
    const Outcome run = RunProgram(
        folder, "run " + Quoted(folder / name) + camera + Quoted(folder / (name + "_run")));
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("_raw: the file is damaged or cut short (wrong checksum)"));
    ExpectSameResults(folder / "folder", folder / (name + "_run"));
  }
  const Outcome info = RunProgram(folder, "info " + Quoted(folder / "MH_01.bag") + " --check");
  EXPECT_THAT(info.out, HasSubstr("19 of 20 frames can be used"));
}

TEST(RunRecording, SaysInOneLineWhatIsWrong) {
  const ScratchFolder folder;
  BagWriter bag;
  const TestImage image{1'000'000'000, "mono8", 8, 6, 8, std::string(48, 'x')};
  bag.Add("/cam0/image_raw", "sensor_msgs/Image", 5, RawImageMessage(Dialect::kRos1, image));
  const std::string bytes = bag.Finish();
  const auto run = [&](const std::string& contents) {
    folder.Write("x.bag", contents);
    const Outcome outcome =
        RunProgram(folder, "run " + Quoted(folder / "x.bag") + " --out " + Quoted(folder / "run"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "run"));
    return outcome.err;
  };
  EXPECT_THAT(run(bytes), HasSubstr("x.bag: expected a calibration of /cam0/image_raw"));
  EXPECT_THAT(run(bytes.substr(0, bytes.size() - 20)), HasSubstr("x.bag: "));
  EXPECT_THAT(run("#ROSBAG V2.0\n"), HasSubstr("expected a bag header"));
}

}  // namespace recording_test
}  // namespace plumbline
