// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "dds_peer.h"
#include "messages.h"
#include "mono_node_test.h"
#include "ros2_node.h"
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

// What happens around a node. Some take seconds: with PLUMBLINE_LONG set.
namespace plumbline {
namespace ros2_network_test {

using testing::HasSubstr;
using Ros2NetworkTest = MonoNodeTest;

const std::vector<std::string> kReliable = {
    "-p", "base_frame:=cam0", "-p", "reliability:=reliable"};

bool IsLong() { return std::getenv("PLUMBLINE_LONG") != nullptr; }

bool TakePose(dds_entity_t poses) {
  return DdsPeer::Take<PoseStamped>(poses, [](const PoseStamped&) {});
}

// A publisher that is there before the node, and stays when a node ends and another one starts.
TEST_F(Ros2NetworkTest, StartsLateAndAgain) {
  if (!IsLong()) GTEST_SKIP();
  DdsPeer peer(Domain());
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  const auto state = peer.MakeReader("rt/plumbline/state", std_msgs_msg_dds__String__desc);
  std::size_t index = 0;
  for (; index < 5; ++index) Publish(images, index);
  for (int start = 0; start < 3; ++start) {
    Ros2Node node(MonoArguments(kReliable));
    EXPECT_TRUE(WaitUntil([&] {
      Publish(images, index++ % dataset_->size());
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return DdsPeer::Take<std_msgs_msg_dds__String_>(state, [](const auto&) {});
    })) << start
        << node.Said();
    EXPECT_EQ(start == 1 ? node.Kill() : node.Stop(), start == 1 ? -1 : 0);
  }
}

// Reliable, keeps all and takes nothing, so that it acknowledges no more than one message.
TEST_F(Ros2NetworkTest, DoesNotWaitForASubscriberThatDoesNotTake) {
  DdsPeer peer(Domain()), slow(Domain());
  Ros2Node node(MonoArguments(kReliable));
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  PeerQos one;
  one.most_samples = 1;
  const auto type = sensor_msgs_msg_dds__PointCloud2__desc;
  const std::vector<dds_entity_t> unread = {
      slow.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc, one),
      slow.MakeReader("rt/plumbline/odometry", nav_msgs_msg_dds__Odometry__desc, one),
      slow.MakeReader("rt/tf", tf2_msgs_msg_dds__TFMessage__desc, one),
      slow.MakeReader("rt/plumbline/points", type, one)};
  const auto state = peer.MakeReader("rt/plumbline/state", std_msgs_msg_dds__String__desc);
  ASSERT_TRUE(WaitUntil([&] {
    bool all = DdsPeer::HasReader(images) && DdsPeer::HasWriter(state);
    for (const dds_entity_t reader : unread) all = all && DdsPeer::HasWriter(reader);
    return all;
  })) << node.Said();
  constexpr std::size_t kFrames = 15;
  for (std::size_t i = 0; i < kFrames; ++i) {
    Publish(images, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(dds_wait_for_acks(images, DDS_SECS(5)), DDS_RETCODE_OK);
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("15 frames came"));
}

// The system clock of the node is set ahead by an hour, and back by two: poses come, and so do
// maps, for which a timer runs.
TEST_F(Ros2NetworkTest, GoesOnWhenTheSystemClockJumps) {
  if (!IsLong()) GTEST_SKIP();
  const ScratchFolder folder;
  const std::string clock = (folder / "clock").string();
  const auto set_clock = [&](std::int64_t seconds) {
    std::fstream file(clock, std::ios::in | std::ios::out | std::ios::binary);
    if (!file) file.open(clock, std::ios::out | std::ios::binary);
    file.write(reinterpret_cast<const char*>(&seconds), sizeof(seconds));
  };
  set_clock(0);
  DdsPeer peer(Domain());
  std::vector<std::string> arguments = MonoArguments(kReliable);
  arguments.insert(arguments.end(), {"-p", "map_period:=0.2"});
  Ros2Node node(arguments,
                {true, {{"LD_PRELOAD", PLUMBLINE_JUMPING_CLOCK}, {"JUMPING_CLOCK", clock}}});
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  const auto poses = peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  const auto points =
      peer.MakeReader("rt/plumbline/points", sensor_msgs_msg_dds__PointCloud2__desc, {true, true});
  ASSERT_TRUE(WaitUntil([&] {
    return DdsPeer::HasReader(images) && DdsPeer::HasWriter(poses) && DdsPeer::HasWriter(points);
  })) << node.Said();
  std::size_t index = 0;
  for (const std::int64_t seconds : {0, 3600, -3600}) {
    set_clock(seconds);
    while (TakePose(poses)) {
    }
    std::size_t with_pose = 0, with_map = 0;
    EXPECT_TRUE(WaitUntil([&] {
      Publish(images, index++);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      while (TakePose(poses)) ++with_pose;
      while (DdsPeer::Take<sensor_msgs_msg_dds__PointCloud2_>(points, [](const auto&) {})) {
        ++with_map;
      }
      return (with_pose >= 10 && with_map >= 2) || index >= dataset_->size();
    })) << seconds
        << node.Said();
    EXPECT_GE(with_pose, 10U) << seconds;
    EXPECT_GE(with_map, 2U) << seconds;
  }
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

int Shell(const std::string& commands) {
  return std::system(("set -e; " + commands).c_str());  // NOLINT(concurrency-mt-unsafe)
}

// Two networks, joined by a veth pair: the test runs itself in one that is nobody else's, and the
// node in another one.
TEST_F(Ros2NetworkTest, FindsOthersInAnotherNetwork) {
  if (!IsLong()) GTEST_SKIP();
  if (std::getenv("PLUMBLINE_OWN_NETWORK") == nullptr) {
    if (Shell("unshare -n true; ip -V > /dev/null") != 0) {
      GTEST_SKIP() << "no network namespaces: root, unshare and ip are needed";
    }
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    ASSERT_EQ(Shell("PLUMBLINE_OWN_NETWORK=1 unshare -n '" + self +
                    "' --gtest_filter=Ros2NetworkTest.FindsOthersInAnotherNetwork"),
              0);
    return;
  }
  Ros2Node node(MonoArguments(kReliable), {false, {}, true});
  ASSERT_EQ(node.WaitUntilStopped(), SIGSTOP);
  const std::string pid = std::to_string(node.pid()), other = "nsenter -n -t " + pid + " ";
  ASSERT_EQ(Shell("ip link add plumbline0 type veth peer name plumbline1 netns " + pid +
                  "; ip address add 10.77.0.1/24 dev plumbline0; ip link set plumbline0 up; " +
                  "ip link set lo up; " + other + "ip address add 10.77.0.2/24 dev plumbline1; " +
                  other + "ip link set plumbline1 up; " + other + "ip link set lo up"),
            0);
  // Nodes use the interfaces that are up when they start.
  ASSERT_TRUE(WaitUntil(
      [&] { return Shell(other + "ip link show plumbline1 | grep -q 'state UP'") == 0; }));
  ::kill(node.pid(), SIGCONT);
  {  // The participant has to end before the node, whose network goes with it.
    DdsPeer peer(Domain(), "plumbline0");
    const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
    const auto poses =
        peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasWriter(poses); }))
        << node.Said();
    std::size_t index = 0;
    EXPECT_TRUE(WaitUntil([&] {
      Publish(images, index++ % dataset_->size());
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return TakePose(poses);
    })) << node.Said();
  }
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

}  // namespace ros2_network_test
}  // namespace plumbline
