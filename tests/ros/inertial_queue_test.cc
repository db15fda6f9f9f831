// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/inertial_queue.h"

#include "plumbline/base/error.h"

#include "tests/io/scratch_folder.h"
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace inertial_queue_test {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kFrame = 1'403'636'580'000 * kMs;

InertialSample At(std::int64_t stamp_ns) { return {stamp_ns, {0.1, 0, 0}, {0, 0, 9.8}}; }

// Adds samples at 200 Hz, from 50 ms before the frame to `last` of it.
void AddUpTo(std::int64_t last_ms, InertialQueue& queue) {
  for (std::int64_t ms = -50; ms <= last_ms; ms += 5) queue.Add(At(kFrame + ms * kMs));
}

TEST(InertialQueue, FramesWaitForTheirSamples) {
  for (const bool patient : {false, true}) {
    InertialQueue queue(0.01, patient);  // the sensor's clock is 10 ms ahead
    EXPECT_FALSE(queue.MustWait(kFrame, kFrame)) << "no sensor is there";
    AddUpTo(5, queue);
    EXPECT_TRUE(queue.MustWait(kFrame, kFrame));
    EXPECT_TRUE(queue.MustWait(kFrame, kFrame + 50 * kMs));
    EXPECT_FALSE(queue.MustWait(kFrame, kFrame + 101 * kMs)) << "the frame has waited enough";
    queue.Add(At(kFrame + 10 * kMs));
    EXPECT_EQ(queue.MustWait(kFrame, kFrame), patient);
    queue.Add(At(kFrame + 30 * kMs));
    EXPECT_FALSE(queue.MustWait(kFrame, kFrame));
    EXPECT_FALSE(queue.MustWait(kFrame + 1021 * kMs, kFrame + 1021 * kMs))
        << "it has fallen silent";
  }
}

// As of a recording: 20 ms beyond the frame's stamp, on the sensor's clock.
TEST(InertialQueue, FramesGetTheSamplesSinceTheOneBefore) {
  InertialQueue queue(0.01, true);
  AddUpTo(100, queue);
  const auto first = queue.TakeUpTo(kFrame);
  ASSERT_EQ(first.size(), 17U);
  EXPECT_EQ(first.front().stamp_ns, kFrame - 50 * kMs);
  EXPECT_EQ(first.back().stamp_ns, kFrame + 30 * kMs);
  const auto second = queue.TakeUpTo(kFrame + 50 * kMs);
  ASSERT_EQ(second.size(), 10U);
  EXPECT_EQ(second.front().stamp_ns, kFrame + 35 * kMs);
  EXPECT_TRUE(queue.TakeUpTo(kFrame).empty());
}

TEST(InertialQueue, OrderIsKeptAndAClockThatIsSetBackBeginsAnew) {
  InertialQueue queue(0, true);
  for (const std::int64_t ms : {0, 5, 5, 3, 10}) queue.Add(At(kFrame + ms * kMs));
  EXPECT_EQ(queue.TakeUpTo(kFrame).size(), 3U);
  AddUpTo(60, queue);
  queue.Add(At(kFrame - 3'600'000 * kMs));
  EXPECT_EQ(queue.TakeUpTo(kFrame + 1000 * kMs).size(), 1U);
}

TEST(SampleOf, RefusesWhatIsNoMeasurement) {
  InertialMessage message;
  message.stamp_ns = kFrame;
  message.angular_rate = {1, 2, 3};
  message.specific_force = {4, 5, 6};
  const auto sample = SampleOf(message);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp_ns, kFrame);
  EXPECT_EQ(sample->angular_rate, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sample->specific_force, Eigen::Vector3d(4, 5, 6));
  const auto refuses = [&](auto change) {
    InertialMessage other = message;
    change(other);
    return !SampleOf(other);
  };
  EXPECT_TRUE(refuses([](InertialMessage& m) { m.stamp_ns = 0; }));
  EXPECT_TRUE(refuses([](InertialMessage& m) { m.has_rate = false; }));
  EXPECT_TRUE(refuses([](InertialMessage& m) { m.angular_rate[1] = std::nan(""); }));
  EXPECT_TRUE(refuses([](InertialMessage& m) { m.specific_force[2] = 1e9; }));
}

constexpr const char* kPlace =
    "  imu_from_left: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1, 0, 0, 0, 1]\n";

TEST(FindInertialCalibration, IsChosenAsForARun) {
  const ScratchFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  const std::string place = write("place.yaml", std::string("imu:\n") + kPlace);
  const std::string clock = write("clock.yaml", "imu:\n  time_offset: 0.25\n");
  EXPECT_FALSE(FindInertialCalibration("off", place));
  EXPECT_FALSE(FindInertialCalibration("auto", "euroc"));  // a built-in camera
  EXPECT_FALSE(FindInertialCalibration("auto", clock));
  const auto of_camera = FindInertialCalibration("auto", place);
  ASSERT_TRUE(of_camera && of_camera->imu_from_left);
  EXPECT_EQ(of_camera->imu_from_left->translation.z(), 0.1);
  const auto both = FindInertialCalibration(clock, place);
  ASSERT_TRUE(both && both->imu_from_left);
  EXPECT_EQ(both->time_offset, 0.25);
  try {
    FindInertialCalibration(clock, "euroc");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("clock.yaml: expected the place of the sensor"));
  }
  EXPECT_THROW(FindInertialCalibration((folder / "none.yaml").string(), place), InputError);
}

}  // namespace inertial_queue_test
}  // namespace plumbline::ros_node
