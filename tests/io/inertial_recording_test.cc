// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/inertial/inertial_recording.h"

#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/recorded_bag.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/inertial_messages.h"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace inertial_recording_test {

const std::string kHeader = "#timestamp [ns],w_x,w_y,w_z,a_x,a_y,a_z\n";

std::string Row(std::int64_t stamp_ns, double rate, double force) {
  return std::to_string(stamp_ns) + "," + std::to_string(rate) + ",0,0,0,0," +
         std::to_string(force) + "\n";
}

TEST(OpenInertialAlone, LeavesOutMalformedRowsAndTellsTheFirst) {
  const ScratchFolder folder;
  const std::string bad = "2,nan,0,0,0,0,0\n3,1,2,3,4,5,inf\n";
  const auto half = folder.Write("a.csv", kHeader + Row(1, 0, 9.8) + bad + Row(4, 0, 9.8));
  const InertialRecording read = OpenInertialAlone(half, {});
  EXPECT_EQ(read.ordered.samples.size(), 2U);
  const std::string first = half.string() + ":3: expected a number in column 2, found 'nan'";
  EXPECT_EQ(
      read.notes,
      std::vector<std::string>{"2 of 4 rows are no samples and are left out; the first: " + first});
  const auto most = folder.Write("a.csv", kHeader + Row(1, 0, 9.8) + bad);
  EXPECT_EQ(MessageOf([&] { OpenInertialAlone(most, {}); }),
            first + " (2 of 3 rows are no samples)");
  const auto empty = folder.Write("a.csv", kHeader);
  EXPECT_EQ(MessageOf([&] { OpenInertialAlone(empty, {}); }),
            empty.string() + ": expected samples, found no rows");
}

TEST(OpenInertialAlone, ReadsNoMoreAtOnceThanIsWanted) {
  const ScratchFolder folder;
  std::string rows;
  for (int i = 0; i < 100; ++i) rows += Row(std::int64_t{i} * 100'000'000 + 1, 0, 9.8);
  const auto file = folder.Write("a.csv", rows);
  const InertialRecording some = OpenInertialAlone(file, {.seconds = 2});
  EXPECT_EQ(some.ordered.samples.size(), 21U);
  EXPECT_FALSE(some.complete);
  std::size_t all = 0;
  for (const auto stream = some.open(); stream->Next();) ++all;
  EXPECT_EQ(all, 100U);
  EXPECT_TRUE(OpenInertialAlone(file, {}).complete);
  const InertialRecording few = OpenInertialAlone(file, {.most = 7});
  EXPECT_EQ(few.ordered.samples.size(), 7U);
  EXPECT_FALSE(few.complete);
}

TEST(OpenInertialAlone, OneStampFarAheadDoesNotEndTheSensor) {
  const ScratchFolder folder;
  for (const int wrong : {0, 1, 50}) {
    std::string rows;
    for (int i = 0; i < 100; ++i) {
      const std::int64_t ahead = i == wrong ? 40 * 365 * 86'400'000'000'000 : 0;
      rows += Row(std::int64_t{i} * 5'000'000 + 1 + ahead, 0, 9.8);
    }
    const InertialRecording read = OpenInertialAlone(folder.Write("a.csv", rows), {.seconds = 600});
    EXPECT_EQ(read.ordered.samples.size(), 99U);
    EXPECT_EQ(read.ordered.ahead, 1U);
    EXPECT_TRUE(read.complete);
  }
}

TEST(FindInertial, TellsOfAFolderInPlaceOfTheFile) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "imu.csv");
  EXPECT_EQ(MessageOf([&] { FindInertial(folder.path(), DatasetFormat::kTum, {}); }),
            (folder / "imu.csv").string() + ": expected a file, found a folder");
  std::filesystem::create_directories(folder / "mav0/imu0");
  std::filesystem::create_symlink("data.csv", folder / "mav0/imu0/data.csv");
  EXPECT_TRUE(MessageOf([&] {
                FindInertial(folder.path(), DatasetFormat::kEuroc, {});
              }).starts_with((folder / "mav0/imu0/data.csv").string() + ": "));
}

TEST(FindInertial, ReadsFoldersAndTheirCalibration) {
  const ScratchFolder folder;
  EXPECT_FALSE(FindInertial(folder.path(), DatasetFormat::kTum, {}));
  folder.Write("imu.csv", Row(10, 0, 9.8) + Row(20, 0, 9.8) + Row(15, 0, 9.8));
  folder.Write(
      "camera.yaml",
      "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nimu:\n  time_offset: 0.5\n  rate_hz: 200\n");
  const auto tum = FindInertial(folder.path(), DatasetFormat::kTum, {});
  ASSERT_TRUE(tum);
  EXPECT_EQ(tum->ordered.samples.size(), 2U);
  EXPECT_EQ(tum->ordered.backward, 1U);
  EXPECT_EQ(tum->calibration.time_offset, 0.5);
  // What users name comes first.
  const auto file = folder.Write("over.yaml", "imu:\n  time_offset: 0.25\n").string();
  const auto over = FindInertial(folder.path(), DatasetFormat::kTum, {.imu = file});
  EXPECT_EQ(over->calibration.time_offset, 0.25);
  EXPECT_EQ(over->calibration.rate_hz, 200);
}

TEST(FindInertial, TurnsThePlacesOfEurocIntoOne) {
  const ScratchFolder folder;
  folder.Write("mav0/imu0/data.csv", Row(10, 0, 9.8) + Row(20, 0, 9.8));
  const auto matrix = [](const std::string& x) {
    return "T_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, " + x +
           ", 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";
  };
  folder.Write("mav0/imu0/sensor.yaml",
               matrix("0.3") +
                   "rate_hz: 200\ngyroscope_noise_density: 1.7e-4\ngyroscope_random_walk: 1.9e-5\n"
                   "accelerometer_noise_density: 2.0e-3\naccelerometer_random_walk: 3.0e-3\n");
  folder.Write("mav0/cam0/sensor.yaml",
               matrix("0.5") +
                   "rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458, "
                   "457, 367, 248]\ndistortion_model: radial-tangential\ndistortion_coefficients: "
                   "[-0.28, 0.07, 0.0002, 0.00002]\n");
  const auto found = FindInertial(folder.path(), DatasetFormat::kEuroc, {});
  ASSERT_TRUE(found && found->calibration.imu_from_left);
  EXPECT_NEAR(found->calibration.imu_from_left->translation.x(), 0.2, 1e-12);
  EXPECT_TRUE(found->calibration.noise);
  EXPECT_TRUE(IsInertialAlone(folder / "mav0/imu0"));
  EXPECT_FALSE(IsInertialAlone(folder.path()));
  const InertialRecording alone = OpenInertialAlone(folder / "mav0/imu0", {});
  EXPECT_EQ(alone.ordered.samples.size(), 2U);
  EXPECT_TRUE(alone.calibration.imu_from_left);
}

TEST(FindInertial, ReadsTheTopicOfABag) {
  const ScratchFolder folder;
  BagWriter bag = StereoBag();
  for (int i = 0; i < 5; ++i) AddInertial(bag, "/imu0", i * 5'000'000 + 1, 0.1 * i, 9.8);
  bag.Add("/imu0", "sensor_msgs/Imu", 7, "short");
  const auto file = Write(folder, std::move(bag));
  const auto found = FindInertial(file, DatasetFormat::kBag, {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->ordered.samples.size(), 5U);
  EXPECT_EQ(found->ordered.samples[2].stamp_ns, 10'000'001);
  EXPECT_EQ(found->ordered.samples[2].angular_rate.x(), 0.2);
  EXPECT_EQ(found->ordered.samples[2].specific_force.z(), 9.8);
  EXPECT_EQ(found->source, "/imu0 of " + file.string());
  EXPECT_EQ(found->notes,
            (std::vector<std::string>{"1 of 6 messages of /imu0 are no samples and are left out"}));
  BagWriter broken = StereoBag();
  for (int i = 0; i < 2; ++i) AddInertial(broken, "/imu0", i * 5'000'000 + 1, 0.1 * i + 0.1, 9.8);
  for (int i = 0; i < 3; ++i) broken.Add("/imu0", "sensor_msgs/Imu", 7 + i, "short");
  const auto most = folder.Write("most.bag", broken.Finish());
  EXPECT_EQ(MessageOf([&] { FindInertial(most, DatasetFormat::kBag, {}); }),
            "/imu0 of " + most.string() +
                ": expected samples, but 3 of 5 messages of /imu0 are no samples");
  BagWriter useless = StereoBag();
  for (int i = 0; i < 3; ++i) useless.Add("/imu0", "sensor_msgs/Imu", 7 + i, "short");
  const auto none = folder.Write("none.bag", useless.Finish());
  EXPECT_EQ(MessageOf([&] { FindInertial(none, DatasetFormat::kBag, {}); }),
            "/imu0 of " + none.string() +
                ": expected samples, but 3 of 3 messages of /imu0 are no samples");
  // The images are those of before, also where users name the topic of the sensor.
  EXPECT_EQ(OpenDataset(file, {})->size(), 2U);
  DatasetOptions named;
  named.topics = {"/imu0"};
  EXPECT_EQ(OpenDataset(file, named)->size(), 2U);
}

TEST(FindInertial, JoinsAGyroscopeAndAnAccelerometerApart) {
  const ScratchFolder folder;
  BagWriter bag = StereoBag();
  for (int i = 0; i <= 40; ++i) {
    AddInertial(bag, "/gyro/sample", i * 2'500'000 + 1, 0.01 * i + 0.01, std::nullopt);
  }
  for (int i = 0; i <= 10; ++i) AddInertial(bag, "/accel/sample", i * 10'000'000 + 1, {}, 9 + i);
  const auto found = FindInertial(Write(folder, std::move(bag)), DatasetFormat::kBag, {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->ordered.samples.size(), 41U);
  EXPECT_NEAR(found->ordered.samples[6].angular_rate.x(), 0.07, 1e-12);
  EXPECT_NEAR(found->ordered.samples[6].specific_force.z(), 10.5, 1e-6);
}

TEST(FindInertial, TakesOneOfSeveralSensors) {
  const ScratchFolder folder;
  BagWriter bag = StereoBag();
  for (int i = 0; i < 5; ++i) {
    AddInertial(bag, "/a/imu", i * 5'000'000 + 1, 0.1, 9.8);
    AddInertial(bag, "/b/imu", i * 5'000'000 + 1, 0.2, 9.8);
  }
  const auto file = Write(folder, std::move(bag));
  const auto first = FindInertial(file, DatasetFormat::kBag, {});
  EXPECT_EQ(first->ordered.samples[0].angular_rate.x(), 0.1);
  EXPECT_EQ(first->notes.size(), 1U);
  const auto named = FindInertial(file, DatasetFormat::kBag, {.topics = {"/b/imu"}});
  EXPECT_EQ(named->ordered.samples[0].angular_rate.x(), 0.2);
  EXPECT_TRUE(named->notes.empty());
}

}  // namespace inertial_recording_test
}  // namespace plumbline
