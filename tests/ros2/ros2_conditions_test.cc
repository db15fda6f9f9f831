// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "dds_peer.h"
#include "messages.h"
#include "mono_node_test.h"
#include "ros2_node.h"
#include "tests/support/data_folder.h"
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using CompressedImage = sensor_msgs_msg_dds__CompressedImage_;
using CameraInfo = sensor_msgs_msg_dds__CameraInfo_;
using Imu = sensor_msgs_msg_dds__Imu_;
using TransformsOf = tf2_msgs_msg_dds__TFMessage_;
using Ros2ConditionsTest = MonoNodeTest;

TEST_F(Ros2ConditionsTest, PublishesTheMountingThatItAssumesAndCountsMeasurements) {
  DdsPeer peer(Domain());
  Ros2Node node(MonoArguments({}));
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  const auto imu = peer.MakeWriter("rt/imu", sensor_msgs_msg_dds__Imu__desc);
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasReader(imu); }));
  ASSERT_TRUE(WaitUntil([&] {
    Imu message{};
    std::string frame = "imu0";
    message.header.frame_id = frame.data();
    message.linear_acceleration.z = 9.81;
    dds_write(imu, &message);
    return node.Said().find("measurements come, and are not used (parameter imu)") !=
           std::string::npos;
  })) << node.Said();
  ASSERT_TRUE(PublishUntilSaid(images, node, "tf knows no transform from base_link to cam0"))
      << node.Said();
  // Transient local: who comes later gets it.
  const auto transforms =
      peer.MakeReader("rt/tf_static", tf2_msgs_msg_dds__TFMessage__desc, {true, true});
  bool came = false;
  EXPECT_TRUE(WaitUntil([&] {
    return came || DdsPeer::Take<TransformsOf>(transforms, [&](const TransformsOf& message) {
             ASSERT_EQ(message.transforms._length, 1U);
             const auto& one = message.transforms._buffer[0];
             EXPECT_STREQ(one.header.frame_id, "base_link");
             EXPECT_STREQ(one.child_frame_id, "cam0");
             // z of the camera is x of the base, its x is -y (REP 103, optical frames).
             const auto& q = one.transform.rotation;
             const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
             EXPECT_LT((rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(),
                       1e-12);
             EXPECT_LT((rotation * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(),
                       1e-12);
             came = true;
           });
  })) << node.Said();
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr(" inertial measurements came"));
}

TEST_F(Ros2ConditionsTest, HearsNothingOfAnotherDomain) {
  Ros2Node node(MonoArguments({"-p", "base_frame:=cam0", "-p", "reliability:=reliable"}));
  // No test is in a domain above 200.
  DdsPeer other(201 + Domain() % 30), same(Domain());
  const auto in_other = MakeImageWriter(other, "rt/cam0/image_raw");
  const auto in_same = MakeImageWriter(same, "rt/cam0/image_raw");
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(in_same); })) << node.Said();
  for (std::size_t i = 0; i < 5; ++i) Publish(in_other, i);
  EXPECT_FALSE(DdsPeer::HasReader(in_other));
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_EQ(node.Said().find("frames came"), std::string::npos) << node.Said();
}

TEST_F(Ros2ConditionsTest, GoesOnWithAPublisherThatComesBackAndStampsThatJump) {
  Ros2Node node(MonoArguments({"-p", "base_frame:=cam0", "-p", "reliability:=reliable"}));
  constexpr std::int64_t kHour = 3600 * kSecond;
  std::size_t frames = 0;
  // A clock that is set back and ahead between one publisher and the next.
  for (const std::int64_t shift : {std::int64_t{0}, -kHour, kHour}) {
    DdsPeer peer(Domain());
    const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
    const auto state =
        peer.MakeReader("rt/plumbline/state", std_msgs_msg_dds__String__desc, {true, true});
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasWriter(state); }))
        << node.Said();
    for (std::size_t i = 0; i < 4; ++i, ++frames) Publish(images, frames, shift);
    EXPECT_TRUE(WaitUntil([&] {
      return DdsPeer::Take<std_msgs_msg_dds__String_>(state, [](const auto&) {});
    })) << node.Said();
    dds_wait_for_acks(images, DDS_SECS(5));
  }
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("warning: stamps jump back by 3599."));
  EXPECT_THAT(node.Said(), HasSubstr("12 frames came")) << node.Said();
}

// Who does not read must not stop the node: another node that is stopped, and subscribes tf.
TEST_F(Ros2ConditionsTest, DoesNotWaitForASubscriberThatHasStopped) {
  DdsPeer peer(Domain());
  Ros2Node node(MonoArguments({"-p", "base_frame:=cam0", "-p", "reliability:=reliable"}));
  Ros2Node sleeper({"-r", "__node:=sleeper", "-r", "image:=/nothing", "-p", "camera:=euroc"});
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  const auto unread = MakeImageWriter(peer, "rt/nothing");
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasReader(unread); }));
  ::kill(sleeper.pid(), SIGSTOP);
  constexpr std::size_t kFrames = 15;
  for (std::size_t i = 0; i < kFrames; ++i) {
    Publish(images, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  dds_wait_for_acks(images, DDS_SECS(5));
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("15 frames came"));
  ::kill(sleeper.pid(), SIGCONT);
  EXPECT_EQ(sleeper.Stop(), 0);
}

// Datagrams that are none of DDS, or begin as such and go on with noise, at the ports of the
// two participants of the domain (DDSI-RTPS 2.2, 9.6.1.1).
TEST_F(Ros2ConditionsTest, GoesOnAfterGarbageAtItsPorts) {
  Ros2Node node(MonoArguments({"-p", "base_frame:=cam0", "-p", "reliability:=reliable"}));
  DdsPeer peer(Domain());
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images); })) << node.Said();
  const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(sender, 0);
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes(1 + rng.Index(400));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.Index(256));
    constexpr std::array<std::uint8_t, 6> kStart = {'R', 'T', 'P', 'S', 2, 2};
    if (i % 2 == 1 && bytes.size() > kStart.size()) {
      std::copy(kStart.begin(), kStart.end(), bytes.begin());
    }
    for (const unsigned offset : {10U, 11U, 12U, 13U}) {
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * Domain() + offset));
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      ::sendto(sender, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof(to));
    }
  }
  ::close(sender);
  for (std::size_t i = 0; i < 3; ++i) Publish(images, i);
  dds_wait_for_acks(images, DDS_SECS(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("3 frames came"));
}

// With PLUMBLINE_LONG set. All images come before the joins, so that what grows is the joins'. Of
// those that left DDS keeps a little (discovery, RTPS histories), which may not add up.
TEST_F(Ros2ConditionsTest, KeepsItsMemoryWhileAHundredJoinAndLeave) {
  if (std::getenv("PLUMBLINE_LONG") == nullptr) GTEST_SKIP();
  Ros2Node node(MonoArguments({"-p", "base_frame:=cam0", "-p", "reliability:=reliable"}));
  {
    DdsPeer peer(Domain());
    const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images); })) << node.Said();
    for (std::size_t i = 0; i < 10; ++i) Publish(images, i);
    dds_wait_for_acks(images, DDS_SECS(5));
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  double after_ten = 0;
  constexpr int kJoins = 100;
  for (int i = 0; i < kJoins; ++i) {
    if (i == 10) after_ten = MemoryOf(node.pid());
    DdsPeer peer(Domain());
    const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
    const auto poses =
        peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasWriter(poses); }))
        << i << node.Said();
  }
  const double after_all = MemoryOf(node.pid());
  const double kilobytes_a_join = 1000 * (after_all - after_ten) / (kJoins - 10);
  std::printf("resident: %.1f MB after 10 joins, %.1f MB after %d: %.0f kB a join\n",
              after_ten,
              after_all,
              kJoins,
              kilobytes_a_join);
  EXPECT_LT(kilobytes_a_join, 50);
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("10 frames came"));
}

void WriteCameraInfo(dds_entity_t writer, const CameraIntrinsics& camera) {
  std::string frame_id = "cam0", model = "plumb_bob";
  std::vector<double> d(camera.distortion.begin(), camera.distortion.begin() + 5);
  CameraInfo info{};
  info.header.frame_id = frame_id.data();
  info.distortion_model = model.data();
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.d._buffer = d.data();
  info.d._length = info.d._maximum = 5;
  const std::array<double, 9> k = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  std::copy(k.begin(), k.end(), info.k);
  for (int i : {0, 4, 8}) info.r[i] = 1;
  for (int i = 0; i < 9; ++i) info.p[i + i / 3] = k[static_cast<std::size_t>(i)];
  dds_write(writer, &info);
  dds_wait_for_acks(writer, DDS_SECS(5));
}

void WriteDepth(dds_entity_t writer, const SensorFrame& frame) {
  std::vector<std::uint8_t> no_pixels;
  std::string encoding = "32FC1";
  DdsImage message = DdsImageOf(frame.left, frame.stamp_ns, no_pixels);
  const DepthImage& metres = *frame.depth;
  std::vector<float> values;
  for (int y = 0; y < metres.height(); ++y) {
    values.insert(values.end(), metres.row(y), metres.row(y) + metres.width());
  }
  message.encoding = encoding.data();
  message.step = 4 * message.width;
  message.data._buffer = reinterpret_cast<std::uint8_t*>(values.data());
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(4 * values.size());
  dds_write(writer, &message);
}

// Sends the file of a frame of TUM's as it is. Returns false if there is none.
bool WriteCompressed(dds_entity_t writer,
                     const std::filesystem::path& sequence,
                     const SensorFrame& frame) {
  char name[64];
  std::snprintf(name,
                sizeof(name),
                "rgb/%lld.%06lld.webp",
                static_cast<long long>(frame.stamp_ns / kSecond),
                static_cast<long long>(frame.stamp_ns % kSecond / 1000));
  std::string file = Contents(sequence / name), format = "webp";
  std::vector<std::uint8_t> no_pixels;
  const DdsImage like = DdsImageOf(frame.left, frame.stamp_ns, no_pixels);
  CompressedImage message{};
  message.header = like.header;
  message.format = format.data();
  message.data._buffer = reinterpret_cast<std::uint8_t*>(file.data());
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(file.size());
  dds_write(writer, &message);
  return !file.empty();
}

// Compressed colour images, depth and camera_info: each frame gets a pose with its stamp.
TEST(Ros2Rgbd, TakesCompressedImagesDepthAndCameraInfo) {
  const auto sequence = FindData("tum/rgbd_dataset_freiburg1_floor_first90");
  if (!sequence) GTEST_SKIP() << "the sequence is not there";
  const auto dataset = OpenDataset(*sequence, {});
  DdsPeer peer(Domain());
  std::vector<std::string> arguments = {"image:=/rgb", "camera_info:=/rgb/info", "depth:=/depth"};
  for (const char* parameter : {"sensor:=rgbd",
                                "image_transport:=compressed",
                                "reliability:=reliable",
                                "base_frame:=cam0",
                                "options.slam.mode:=lockstep"}) {
    arguments.insert(arguments.end(), {"-p", parameter});
  }
  Ros2Node node(arguments);
  const auto images =
      peer.MakeWriter("rt/rgb/compressed", sensor_msgs_msg_dds__CompressedImage__desc);
  const auto depths = MakeImageWriter(peer, "rt/depth");
  const auto infos = peer.MakeWriter("rt/rgb/info", sensor_msgs_msg_dds__CameraInfo__desc);
  const auto poses = peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  ASSERT_TRUE(WaitUntil([&] {
    return DdsPeer::HasReader(images) && DdsPeer::HasReader(depths) && DdsPeer::HasReader(infos) &&
           DdsPeer::HasWriter(poses);
  })) << node.Said();
  WriteCameraInfo(infos, dataset->calibration().left.intrinsics());
  std::size_t with_pose = 0;
  constexpr std::size_t kFrames = 6;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto frame = dataset->Read(i);
    ASSERT_TRUE(frame && frame->depth);
    ASSERT_TRUE(WriteCompressed(images, *sequence, *frame));
    WriteDepth(depths, *frame);
    EXPECT_TRUE(WaitUntil([&] {
      return DdsPeer::Take<PoseStamped>(poses, [&](const PoseStamped& message) {
        EXPECT_EQ(StampOf(message.header), frame->stamp_ns);
        ++with_pose;
      });
    })) << i
        << node.Said();
  }
  EXPECT_EQ(with_pose, kFrames);
  EXPECT_EQ(node.Stop(), 0);
  EXPECT_THAT(node.Said(), HasSubstr("6 frames came, 6 have a pose"));
}

}  // namespace
}  // namespace plumbline
