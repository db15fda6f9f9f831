// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_stream.h"

#include "plumbline/io/inertial/inertial_recording.h"

#include "tests/io/recorded_bag.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/inertial_messages.h"
#include "tests/support/mcap_writer.h"
#include "tests/support/rosbag2_writer.h"
#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace inertial_stream_test {

std::vector<InertialSample> AllOf(InertialStream& stream) {
  std::vector<InertialSample> samples;
  while (const auto sample = stream.Next()) samples.push_back(*sample);
  return samples;
}

// Resident memory of this process in bytes.
long ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  long size = 0, resident = 0;
  file >> size >> resident;
  return resident * 4096;
}

TEST(OpenInertialRows, ReadsNanosecondsAndSecondsAndCountsWhatIsNone) {
  const ScratchFolder folder;
  const auto file = folder.Write("a.csv",
                                 "#timestamp [ns],w_x,w_y,w_z,a_x,a_y,a_z\n"
                                 "1403636579763555584,0.5,0,0,0,0,9.8\n"
                                 "1,2,3\n"
                                 "x,1,2,3,4,5,6\n"
                                 "7,1,2,3,4,5,1e9\n"
                                 "1.5,1,2,3,4,5,6\r\n");
  const auto stream = OpenInertialRows(file);
  const auto samples = AllOf(*stream);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].stamp_ns, 1403636579763555584);
  EXPECT_EQ(samples[0].angular_rate, Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(samples[0].specific_force, Eigen::Vector3d(0, 0, 9.8));
  EXPECT_EQ(samples[1].stamp_ns, 1'500'000'000);
  EXPECT_EQ(samples[1].specific_force, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(stream->unusable().count, 3U);
  EXPECT_EQ(stream->unusable().first,
            file.string() +
                ":3: expected a time stamp, three rates in rad/s and three forces in m/s^2, found "
                "3 columns");
}

TEST(ParseInertialSample, SaysWhatIsWrong) {
  const auto fault = [](std::vector<std::string> fields) {
    return ParseInertialSample(fields).error();
  };
  EXPECT_EQ(fault({"x", "1", "2", "3", "4", "5", "6"}),
            "expected a time stamp in whole nanoseconds, or in seconds with a decimal point, found "
            "'x'");
  EXPECT_EQ(fault({"7", "1", "2", "3", "4", "nan", "6"}),
            "expected a number in column 6, found 'nan'");
  EXPECT_EQ(fault({"7", "1", "2", "3", "4", "5", "1e9"}),
            "expected rates in rad/s and forces in m/s^2, found '1e9'");
}

// Ten times as many samples take no more memory.
TEST(OpenInertialRows, HoldsNoMoreOfALongFile) {
  const ScratchFolder folder;
  const auto growth = [&](int rows) {
    {
      std::ofstream file(folder / "a.csv");
      for (int i = 0; i < rows; ++i) {
        file << 1403636579763555584 + std::int64_t{i} * 5'000'000 << ",0.1,0.2,0.3,0.1,0.2,9.8\n";
      }
    }
    const auto stream = OpenInertialRows(folder / "a.csv");
    EXPECT_TRUE(stream->Next());
    const long before = ResidentBytes();
    int count = 1;
    while (stream->Next()) ++count;
    EXPECT_EQ(count, rows);
    return ResidentBytes() - before;
  };
  growth(1000);
  EXPECT_LT(growth(300'000), 2'000'000);  // of 17 MB of samples
}

TEST(OpenInertialTopics, GivesTheSamplesOfOneTopicOrOfTwoJoined) {
  const ScratchFolder folder;
  BagWriter bag = StereoBag();
  for (int i = 0; i <= 10'000; ++i) {
    const std::int64_t stamp_ns = std::int64_t{i} * 2'500'000 + 1;
    AddInertial(bag, "/gyro", stamp_ns, 0.01 * i + 0.01, std::nullopt);
    if (i % 4 == 0) AddInertial(bag, "/accel", stamp_ns, std::nullopt, 9 + i % 7);
    if (i % 2 == 0) AddInertial(bag, "/both", stamp_ns, 0.1, 9.8);
  }
  const auto file = Write(folder, std::move(bag));
  const auto both = OpenInertialTopics(file, DatasetFormat::kBag, {"/both", "/both", true});
  EXPECT_EQ(AllOf(*both).size(), 5001U);
  const auto found = FindInertial(file, DatasetFormat::kBag, {.topics = {"/gyro", "/accel"}});
  ASSERT_TRUE(found);
  const auto joined = AllOf(*found->open());
  const auto& whole = found->ordered.samples;
  ASSERT_EQ(joined.size(), whole.size());
  EXPECT_EQ(joined.size(), 10'001U);
  EXPECT_TRUE(std::equal(joined.begin(), joined.end(), whole.begin(), [](auto& a, auto& b) {
    return a.stamp_ns == b.stamp_ns && a.angular_rate == b.angular_rate &&
           a.specific_force == b.specific_force;
  }));
}

// The same in MCAP and in ROS 2's own bags.
TEST(OpenInertialTopics, JoinsTopicsOfRos2) {
  const ScratchFolder folder;
  McapWriter mcap;
  Rosbag2Writer bag(folder / "bag.db3");
  for (int i = 0; i <= 40; ++i) {
    const std::int64_t stamp_ns = std::int64_t{i} * 2'500'000 + 1;
    const auto add = [&](const std::string& topic, const std::string& message) {
      mcap.Add(topic, "sensor_msgs/msg/Imu", "cdr", stamp_ns, message);
      bag.Add(topic, "sensor_msgs/msg/Imu", stamp_ns, message);
    };
    add("/gyro", InertialMessageOf(Dialect::kCdr, stamp_ns, 0.01 * i + 0.01, std::nullopt));
    if (i % 4 == 0) add("/accel", InertialMessageOf(Dialect::kCdr, stamp_ns, std::nullopt, 9 + i));
  }
  for (const auto& [file, format] :
       {std::pair{folder.Write("x.mcap", mcap.Finish()), DatasetFormat::kMcap},
        std::pair{folder / "bag.db3", DatasetFormat::kRosbag2}}) {
    const auto found = FindInertial(file, format, {});
    ASSERT_TRUE(found) << file;
    const auto joined = AllOf(*found->open());
    ASSERT_EQ(joined.size(), 41U) << file;
    EXPECT_EQ(joined[2].stamp_ns, 5'000'001);
    EXPECT_NEAR(joined[2].angular_rate.x(), 0.03, 1e-12);
    EXPECT_NEAR(joined[2].specific_force.z(), 11, 1e-6);
  }
}

TEST(OpenInertialTopics, EndsWithoutBeingReadToTheEnd) {
  const ScratchFolder folder;
  BagWriter bag = StereoBag();
  for (int i = 0; i < 20'000; ++i)
    AddInertial(bag, "/imu", std::int64_t{i} * 2'500'000 + 1, 0.1, 9.8);
  const auto file = Write(folder, std::move(bag));
  const auto stream = OpenInertialTopics(file, DatasetFormat::kBag, {"/imu", "/imu", true});
  ASSERT_TRUE(stream->Next());
  EXPECT_EQ(stream->Next()->stamp_ns, 2'500'001);
}

}  // namespace inertial_stream_test
}  // namespace plumbline
