// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros2_node.h"

#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/inertial/inertial_calibration_file.h"
#include "plumbline/io/inertial/inertial_recording.h"
#include "plumbline/io/trajectory_io.h"

#include "dds_peer.h"
#include "messages.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::Not;

using Odometry = nav_msgs_msg_dds__Odometry_;
using Transforms = tf2_msgs_msg_dds__TFMessage_;
using Nodes = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;

// Publishes the images of a pair.
class PairPublisher {
 public:
  PairPublisher(DdsPeer& peer, PeerQos qos)
      : left_(peer.MakeWriter("rt/cam0/image_raw", sensor_msgs_msg_dds__Image__desc, qos)),
        right_(peer.MakeWriter("rt/cam1/image_raw", sensor_msgs_msg_dds__Image__desc, qos)) {}

  bool HasReaders() const { return DdsPeer::HasReader(left_) && DdsPeer::HasReader(right_); }
  void Publish(const SensorFrame& frame) {
    std::vector<std::uint8_t> pixels;
    const DdsImage left = DdsImageOf(frame.left, frame.stamp_ns, pixels);
    dds_write(left_, &left);
    const DdsImage right = DdsImageOf(*frame.right, frame.stamp_ns, pixels);
    dds_write(right_, &right);
  }

 private:
  dds_entity_t left_, right_;
};

Rigid3 MotionOf(const geometry_msgs_msg_dds__Pose_& pose) {
  const auto& q = pose.orientation;
  const auto& p = pose.position;
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z), {p.x, p.y, p.z}};
}

class Ros2NodeTest : public testing::Test {
 protected:
  // Frames of MH_01, or none.
  void SetUp() override {
    sequence_ = FindData("euroc/MH_01_easy_first250");
    if (sequence_) dataset_ = OpenDataset(*sequence_, {});
  }

  std::optional<std::filesystem::path> sequence_;
  std::unique_ptr<Dataset> dataset_;
  DdsPeer peer_{Domain()};
};

// One message for each frame: the covariance is known but for the first, and tf leads from the map
// to the base.
void ExpectOdometry(dds_entity_t odometry, dds_entity_t tf, std::size_t frames) {
  std::size_t with_covariance = 0, count = 0;
  const auto expect_frames = [&](const std::function<bool()>& take) {
    WaitUntil([&] {
      while (take()) ++count;
      return count >= frames;
    });
    EXPECT_EQ(std::exchange(count, 0), frames);
  };
  expect_frames([&] {
    return DdsPeer::Take<Odometry>(odometry, [&](const Odometry& message) {
      EXPECT_STREQ(message.header.frame_id, "odom");
      EXPECT_STREQ(message.child_frame_id, "cam0");
      if (message.pose.covariance[0] > 0) ++with_covariance;
      EXPECT_EQ(message.pose.covariance[1], message.pose.covariance[6]);
    });
  });
  EXPECT_GE(with_covariance, frames - 2);
  expect_frames([&] {
    return DdsPeer::Take<Transforms>(tf, [&](const Transforms& message) {
      ASSERT_EQ(message.transforms._length, 2U);
      EXPECT_STREQ(message.transforms._buffer[0].child_frame_id, "cam0");
      EXPECT_STREQ(message.transforms._buffer[1].child_frame_id, "odom");
      EXPECT_EQ(message.transforms._buffer[1].transform.rotation.w, 1);
    });
  });
}

// Who comes late gets the map and the state. `publish`: one more frame.
void ExpectLatched(const std::function<void()>& publish, const Ros2Node& node) {
  const PeerQos latched{true, true};
  DdsPeer late(Domain());
  const auto points =
      late.MakeReader("rt/plumbline/points", sensor_msgs_msg_dds__PointCloud2__desc, latched);
  const auto lines =
      late.MakeReader("rt/plumbline/lines", visualization_msgs_msg_dds__MarkerArray__desc, latched);
  const auto path = late.MakeReader("rt/plumbline/path", nav_msgs_msg_dds__Path__desc, latched);
  const auto state = late.MakeReader("rt/plumbline/state", std_msgs_msg_dds__String__desc, latched);
  ASSERT_TRUE(WaitUntil([&] {
    return DdsPeer::HasWriter(points) && DdsPeer::HasWriter(lines) && DdsPeer::HasWriter(path);
  }));
  publish();
  bool has_points = false, has_lines = false, has_path = false, has_state = false;
  EXPECT_TRUE(WaitUntil([&] {
    DdsPeer::Take<sensor_msgs_msg_dds__PointCloud2_>(points, [&](const auto& message) {
      EXPECT_STREQ(message.header.frame_id, "map");
      EXPECT_EQ(message.fields._length, 3U);
      EXPECT_STREQ(message.fields._buffer[2].name, "z");
      EXPECT_EQ(message.fields._buffer[2].offset, 8U);
      EXPECT_EQ(message.data._length, message.width * message.point_step);
      has_points = message.width > 100;
    });
    DdsPeer::Take<visualization_msgs_msg_dds__MarkerArray_>(lines, [&](const auto& message) {
      ASSERT_EQ(message.markers._length, 1U);
      const auto& marker = message.markers._buffer[0];
      EXPECT_EQ(marker.type, 5);
      EXPECT_EQ(marker.pose.orientation.w, 1);
      EXPECT_EQ(marker.color.a, 1);
      EXPECT_EQ(marker.points._length % 2, 0U);
      has_lines = marker.points._length > 10;
    });
    DdsPeer::Take<nav_msgs_msg_dds__Path_>(path, [&](const auto& message) {
      has_path = message.poses._length >= 1 && message.poses._buffer[0].pose.orientation.w == 1;
    });
    DdsPeer::Take<std_msgs_msg_dds__String_>(
        state, [&](const auto& message) { has_state = message.data == std::string("tracked"); });
    return has_points && has_lines && has_path && has_state;
  })) << has_points
      << has_lines << has_path << has_state << node.Said();
}

TEST_F(Ros2NodeTest, LockstepGivesTheTrajectoryOfTheFolder) {
  if (!dataset_) GTEST_SKIP() << "the sequence is not there";
  constexpr std::size_t kFrames = 25;
  const ScratchFolder folder;
  const std::string out = (folder / "run").string();
  const Outcome run = RunProgram(folder,
                                 "run " + Quoted(*sequence_) + " --camera euroc --imu off --to " +
                                     std::to_string(kFrames) + " --quiet --out " + Quoted(out));
  ASSERT_EQ(run.code, 0) << run.err;

  Ros2Node node(PairArguments({"-p", "map_period:=0.2"}));
  PairPublisher publisher(peer_, {});
  const auto poses =
      peer_.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  const auto odometry = peer_.MakeReader("rt/plumbline/odometry", nav_msgs_msg_dds__Odometry__desc);
  const auto tf = peer_.MakeReader("rt/tf", tf2_msgs_msg_dds__TFMessage__desc);
  ASSERT_TRUE(WaitUntil([&] {
    return publisher.HasReaders() && DdsPeer::HasWriter(poses) && DdsPeer::HasWriter(odometry) &&
           DdsPeer::HasWriter(tf);
  })) << node.Said();

  Trajectory trajectory;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto frame = dataset_->Read(i);
    ASSERT_TRUE(frame);
    publisher.Publish(*frame);
    bool came = false;
    ASSERT_TRUE(WaitUntil([&] {
      return came || DdsPeer::Take<PoseStamped>(poses, [&](const PoseStamped& message) {
               EXPECT_STREQ(message.header.frame_id, "map");
               EXPECT_EQ(StampOf(message.header), frame->stamp_ns);
               trajectory.push_back({StampOf(message.header), MotionOf(message.pose)});
               came = true;
             });
    })) << node.Said();
  }
  EXPECT_EQ(FormatTum(trajectory), Contents(std::filesystem::path(out) / "trajectory_causal.txt"));

  ExpectOdometry(odometry, tf, kFrames);
  const auto next = dataset_->Read(kFrames);
  ASSERT_TRUE(next);
  ExpectLatched([&] { publisher.Publish(*next); }, node);
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

// The samples of the folder's inertial sensor that are not sent yet, up to so many ns.
class InertialPublisher {
 public:
  InertialPublisher(DdsPeer& peer, std::vector<InertialSample> samples)
      : writer_(peer.MakeWriter("rt/imu", sensor_msgs_msg_dds__Imu__desc)),
        samples_(std::move(samples)) {}

  bool HasReader() const { return DdsPeer::HasReader(writer_); }
  void PublishUpTo(std::int64_t stamp_ns) {
    std::string frame = "imu0";
    for (; next_ < samples_.size() && samples_[next_].stamp_ns <= stamp_ns; ++next_) {
      const InertialSample& sample = samples_[next_];
      sensor_msgs_msg_dds__Imu_ message{};
      message.header.stamp.sec = static_cast<std::int32_t>(sample.stamp_ns / kSecond);
      message.header.stamp.nanosec = static_cast<std::uint32_t>(sample.stamp_ns % kSecond);
      message.header.frame_id = frame.data();
      const auto set = [](const Eigen::Vector3d& from, geometry_msgs_msg_dds__Vector3_& to) {
        to = {from.x(), from.y(), from.z()};
      };
      set(sample.angular_rate, message.angular_velocity);
      set(sample.specific_force, message.linear_acceleration);
      dds_write(writer_, &message);
    }
  }

 private:
  dds_entity_t writer_;
  std::vector<InertialSample> samples_;
  std::size_t next_ = 0;
};

// Samples that come behind the images for which they are: frames wait, and the gyroscope is used as
// by a run on the folder.
TEST_F(Ros2NodeTest, UsesTheGyroscopeAsARunDoes) {
  if (!dataset_) GTEST_SKIP() << "the sequence is not there";
  constexpr std::size_t kFrames = 15;
  const ScratchFolder folder;
  const auto causal = [&](const std::string& arguments) {
    const std::string out = (folder / (arguments == " --imu off" ? "without" : "with")).string();
    const Outcome run =
        RunProgram(folder,
                   "run " + Quoted(*sequence_) + " --camera euroc --quiet --to " +
                       std::to_string(kFrames) + arguments + " --out " + Quoted(out));
    EXPECT_EQ(run.code, 0) << run.err;
    return Contents(std::filesystem::path(out) / "trajectory_causal.txt");
  };
  const std::string without = causal(" --imu off"), with = causal(" --imu auto");
  ASSERT_NE(with, without);

  auto recording = FindInertial(*sequence_, DatasetFormat::kEuroc, {});
  ASSERT_TRUE(recording);
  const std::string calibration = (folder / "imu.yaml").string();
  std::ofstream(calibration) << FormatInertialCalibration(recording->calibration);
  std::vector<InertialSample> samples = recording->ordered.samples;
  const std::int64_t first_ns = dataset_->Read(0)->stamp_ns;
  std::erase_if(samples, [&](const auto& s) { return s.stamp_ns < first_ns - kSecond / 5; });

  Ros2Node node(PairArguments({"-p", "imu:=" + calibration}));
  PairPublisher publisher(peer_, {});
  InertialPublisher inertial(peer_, samples);
  const auto poses =
      peer_.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  ASSERT_TRUE(WaitUntil([&] {
    return publisher.HasReaders() && inertial.HasReader() && DdsPeer::HasWriter(poses);
  })) << node.Said();
  Trajectory trajectory;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto frame = dataset_->Read(i);
    ASSERT_TRUE(frame);
    inertial.PublishUpTo(frame->stamp_ns - kSecond / 50);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    publisher.Publish(*frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    inertial.PublishUpTo(frame->stamp_ns + kSecond / 40);
    ASSERT_TRUE(WaitUntil([&] {
      return DdsPeer::Take<PoseStamped>(poses, [&](const PoseStamped& message) {
        trajectory.push_back({StampOf(message.header), MotionOf(message.pose)});
      });
    })) << node.Said();
  }
  EXPECT_EQ(FormatTum(trajectory), with);
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

// The median of the milliseconds from a frame's arrival to its pose, as a run tells it.
double MedianTotal(const std::filesystem::path& timing) {
  std::istringstream rows(Contents(timing));
  std::vector<double> totals;
  std::string row;
  std::getline(rows, row);  // names; the last one is total_ms
  while (std::getline(rows, row)) totals.push_back(std::stod(row.substr(row.rfind(',') + 1)));
  return Median(totals);
}

// Milliseconds from before the images of a pair are handed to DDS: to its pose, and until DDS has
// them.
struct Delays {
  std::vector<double> to_pose, to_publish;
};

// Plays the frames at 20 Hz to a node in live mode, best effort: all come, and none is lost.
void PlayAtTwentyHertz(const std::vector<SensorFrame>& frames, Delays& delays) {
  using Clock = std::chrono::steady_clock;
  DdsPeer peer(Domain());
  Ros2Node node(PairArguments({"-p", "options.slam.mode:=live", "-p", "reliability:=best_effort"}));
  PairPublisher publisher(peer, {});
  const auto poses = peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  ASSERT_TRUE(WaitUntil([&] { return publisher.HasReaders() && DdsPeer::HasWriter(poses); }));
  std::map<std::int64_t, Clock::time_point> sent;
  const auto since = [&](std::int64_t stamp_ns) {
    return std::chrono::duration<double, std::milli>(Clock::now() - sent.at(stamp_ns)).count();
  };
  const auto take_until = [&](Clock::time_point end) {
    while (delays.to_pose.size() < frames.size() && Clock::now() < end) {
      const bool came = DdsPeer::Take<PoseStamped>(poses, [&](const PoseStamped& message) {
        delays.to_pose.push_back(since(StampOf(message.header)));
      });
      if (!came) peer.WaitForMessage(poses, end - Clock::now());
    }
  };
  // The node, too, has to know of all of them.
  std::this_thread::sleep_for(std::chrono::seconds(1));
  auto next = Clock::now();
  for (const SensorFrame& frame : frames) {
    take_until(next += std::chrono::milliseconds(50));
    std::this_thread::sleep_until(next);
    sent[frame.stamp_ns] = Clock::now();
    publisher.Publish(frame);
    delays.to_publish.push_back(since(frame.stamp_ns));
  }
  take_until(Clock::now() + std::chrono::seconds(2));
  EXPECT_EQ(node.Stop(), 0);
  // None is lost on the way, however busy the machine is; with two cores none for want of time.
  EXPECT_THAT(node.Said(), HasSubstr("100 frames came, 100 have a pose, 0 were left out"));
  EXPECT_THAT(node.Said(), Not(HasSubstr("lost on the way")));
  EXPECT_EQ(delays.to_pose.size(), frames.size());
}

// The same spans, from a frame in memory to its pose in memory, over DDS and from files: so many
// pairs of runs, one after the other, each a line, and their medians.
void CompareLatencies(const std::filesystem::path& sequence,
                      const std::vector<SensorFrame>& frames,
                      int pairs) {
  std::vector<double> over_dds, to_publish, from_files, later;
  for (int i = 0; i < pairs; ++i) {
    const ScratchFolder folder;
    const Outcome run = RunProgram(folder,
                                   "run " + Quoted(sequence) + " --camera euroc --imu off --to " +
                                       std::to_string(frames.size()) +
                                       " --mode live --quiet --out " + Quoted(folder / "run"));
    ASSERT_EQ(run.code, 0) << run.err;
    Delays delays;
    PlayAtTwentyHertz(frames, delays);
    ASSERT_FALSE(delays.to_pose.empty());
    over_dds.push_back(Median(delays.to_pose));
    to_publish.push_back(Median(delays.to_publish));
    from_files.push_back(MedianTotal(folder / "run/timing.csv"));
    later.push_back(over_dds.back() - from_files.back());
    std::printf("median ms to the pose: %.2f over DDS, of these %.2f to publish; %.2f from files\n",
                over_dds.back(),
                to_publish.back(),
                from_files.back());
  }
  std::printf(
      "median of %d pairs, ms: %.2f over DDS (%.2f to publish), %.2f from files: "
      "%.2f later\n",
      pairs,
      Median(over_dds),
      Median(to_publish),
      Median(from_files),
      Median(later));
}

// With PLUMBLINE_LONG set, for it needs two cores beside the publisher. PLUMBLINE_LATENCY=N
// compares latencies by N pairs of runs.
TEST_F(Ros2NodeTest, TakesEveryFrameAtTwentyHertz) {
  if (!dataset_ || std::getenv("PLUMBLINE_LONG") == nullptr) GTEST_SKIP();
  constexpr std::size_t kFrames = 100;
  std::vector<SensorFrame> frames;
  for (std::size_t i = 0; i < kFrames; ++i) frames.push_back(*dataset_->Read(i));
  Delays unused;
  PlayAtTwentyHertz(frames, unused);
  const char* pairs = std::getenv("PLUMBLINE_LATENCY");
  if (pairs != nullptr) CompareLatencies(*sequence_, frames, std::atoi(pairs));
}

TEST_F(Ros2NodeTest, GoesOnAfterBrokenMessages) {
  if (!dataset_) GTEST_SKIP() << "the sequence is not there";
  Ros2Node node(PairArguments());
  dds_topic_descriptor_t in_another_name = Broken_desc;
  in_another_name.m_typename = sensor_msgs_msg_dds__Image__desc.m_typename;
  const auto frame = dataset_->Read(0);
  ASSERT_TRUE(frame);
  {
    DdsPeer other(Domain());
    const auto broken = other.MakeWriter("rt/cam0/image_raw", in_another_name);
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(broken); })) << node.Said();
    const Broken bytes = {{1, 2, 3, 4, 5, 6, 7, 255, 255, 255, 255}};
    dds_write(broken, &bytes);
    EXPECT_TRUE(WaitUntil([&] {
      return node.Said().find(
                 "/cam0/image_raw: expected a sensor_msgs/Image, found 16 bytes that "
                 "are none") != std::string::npos;
    })) << node.Said();
  }
  // The publisher is gone. Another one comes, with an image of fewer bytes than it says first.
  PairPublisher publisher(peer_, {});
  const auto left = peer_.MakeWriter("rt/cam0/image_raw", sensor_msgs_msg_dds__Image__desc);
  const auto right = peer_.MakeWriter("rt/cam1/image_raw", sensor_msgs_msg_dds__Image__desc);
  const auto poses =
      peer_.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  ASSERT_TRUE(WaitUntil([&] {
    return publisher.HasReaders() && DdsPeer::HasReader(left) && DdsPeer::HasReader(right) &&
           DdsPeer::HasWriter(poses);
  })) << node.Said();
  std::vector<std::uint8_t> pixels;
  DdsImage lying = DdsImageOf(frame->left, frame->stamp_ns - kSecond, pixels);
  lying.height = 0xffffffff;
  dds_write(left, &lying);
  dds_write(right, &lying);
  EXPECT_TRUE(WaitUntil([&] {
    return node.Said().find(
               "a frame is left out: /cam0/image_raw: an image of 752x4294967295 pixels") !=
           std::string::npos;
  })) << node.Said();
  publisher.Publish(*frame);
  EXPECT_TRUE(WaitUntil([&] {
    return DdsPeer::Take<PoseStamped>(poses, [](const PoseStamped&) {});
  })) << node.Said();
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

TEST_F(Ros2NodeTest, TellsAPublisherOfAnotherQos) {
  Ros2Node node(PairArguments());
  PairPublisher publisher(peer_, {false, false});
  EXPECT_TRUE(WaitUntil([&] {
    return node.Said().find("/cam0/image_raw: a publisher has another QoS") != std::string::npos;
  })) << node.Said();
  EXPECT_FALSE(publisher.HasReaders());
}

TEST_F(Ros2NodeTest, IntroducesItselfAsANode) {
  Ros2Node node({"--ros-args", "-r", "__node:=slam", "-r", "__ns:=/robot", "-p", "camera:=euroc"});
  const auto reader = peer_.MakeReader(
      "ros_discovery_info", rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, {true, true});
  bool came = false;
  EXPECT_TRUE(WaitUntil([&] {
    return came || DdsPeer::Take<Nodes>(reader, [&](const Nodes& message) {
             ASSERT_EQ(message.node_entities_info_seq._length, 1U);
             const auto& one = message.node_entities_info_seq._buffer[0];
             EXPECT_STREQ(one.node_namespace, "/robot");
             EXPECT_STREQ(one.node_name, "slam");
             EXPECT_EQ(one.reader_gid_seq._length, 8U);  // image, imu, tf, tf_static, services
             EXPECT_EQ(one.writer_gid_seq._length, 12U);
             came = true;
           });
  })) << node.Said();
  const auto state =
      peer_.MakeReader("rt/robot/slam/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  EXPECT_TRUE(WaitUntil([&] { return DdsPeer::HasWriter(state); })) << node.Said();
}

// Every endpoint of a type tells its hash, as ROS 2 does from Iron on (`ros2 topic info
// --verbose`).
TEST_F(Ros2NodeTest, TellsTheHashesOfItsTypes) {
  Ros2Node node(PairArguments());
  std::map<std::string, std::string> user_data;  // by name of the topic
  const std::map<std::string, std::string> expected = {
      {"rt/cam0/image_raw", "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {"rt/plumbline/state", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
      {"rt/tf", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"}};
  const std::vector<dds_entity_t> readers = {
      peer_.MakeReaderOf(DDS_BUILTIN_TOPIC_DCPSPUBLICATION),
      peer_.MakeReaderOf(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)};
  // Endpoints come in any order.
  EXPECT_TRUE(WaitUntil([&] {
    for (const dds_entity_t reader : readers) {
      DdsPeer::Take<dds_builtintopic_endpoint_t>(reader, [&](const auto& endpoint) {
        void* data = nullptr;
        std::size_t size = 0;
        if (!dds_qget_userdata(endpoint.qos, &data, &size)) return;
        user_data[endpoint.topic_name] = std::string(static_cast<const char*>(data), size);
        dds_free(data);
      });
    }
    return std::ranges::all_of(expected,
                               [&](const auto& entry) { return user_data.contains(entry.first); });
  })) << node.Said();
  // Those of services are not sent.
  std::erase_if(user_data, [](const auto& entry) { return !entry.first.starts_with("rt/"); });
  for (const auto& [name, data] : user_data) {
    EXPECT_THAT(data, testing::MatchesRegex("typehash=RIHS01_[0-9a-f]+;")) << name;
  }
  for (const auto& [name, hash] : expected) {
    EXPECT_EQ(user_data[name], "typehash=RIHS01_" + hash + ";") << name;
  }
}

TEST(Ros2NodeArguments, AreCheckedBeforeAnythingStarts) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"sensor:=radar", "sensor: expected mono, stereo or rgbd, found radar"},
      {"queue_size:=0", "queue_size: expected at least 1, found 0"},
      {"kamera:=euroc", "kamera: expected a parameter of this node (base_frame, camera"},
      {"use_sim_time:=3", "use_sim_time: expected a truth value"},
  };
  for (const auto& [parameter, message] : cases) {
    Ros2Node node({"-p", parameter});
    EXPECT_EQ(node.Wait(), 2) << parameter;
    EXPECT_THAT(node.Said(), testing::StartsWith("plumbline-ros2: " + message));
  }
}

}  // namespace
}  // namespace plumbline
