// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "dds_peer.h"
#include "ros2_node.h"
#include "tests/support/data_folder.h"
#include "tests/support/message_writer.h"
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

// Messages as bytes that no compiler of IDL would write.
namespace plumbline {
namespace ros2_broken_messages_test {

using testing::HasSubstr;
using Raw = std::vector<std::uint8_t>;

constexpr std::uint32_t kEndless = 0x7fffffff;

void Write(dds_entity_t writer, const std::string& bytes) {
  const Raw message(bytes.begin(), bytes.end());
  dds_write(writer, &message);
  std::this_thread::sleep_for(std::chrono::milliseconds(1));  // queues of the node are short
}

std::string DdsName(const std::string& type) {
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "::msg::dds_::" + type.substr(slash + 1) + "_";
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// The messages of a topic that are none of its type, each in both byte orders.
struct BrokenTopic {
  std::string name, type;
  std::function<std::string(Dialect)> whole;
};

std::string ClockMessage(Dialect dialect) {
  RosFields fields(dialect);
  fields.Time(5);
  return fields.Take();
}

// `transforms` of none is what they say.
std::string TransformsMessage(Dialect dialect) {
  RosFields fields(dialect);
  fields.U32(kEndless);
  fields.Header(5, "map");
  fields.Text("base");
  for (int i = 0; i < 7; ++i) fields.F64(1);
  return fields.Take();
}

std::string WithEndlessText(Dialect dialect) {
  RosFields fields(dialect);
  fields.Time(5);
  fields.U32(kEndless);
  return fields.Take() + "cam0";
}

// An image whose header, encoding and size are right, of 2^31 bytes.
std::string WithEndlessPixels(Dialect dialect) {
  RosFields fields(dialect);
  fields.Header(5, "cam0");
  for (int i = 0; i < 2; ++i) fields.U32(46341);
  fields.Text("mono8");
  fields.U8(0);
  fields.U32(46341);
  fields.U32(kEndless);
  return fields.Take() + std::string(64, 'x');
}

const std::vector<BrokenTopic> kTopics = {
    {"/rgb/compressed",
     "sensor_msgs/CompressedImage",
     [](Dialect d) {
       return CompressedImageMessage(d, {5, "jpeg", 0, 0, 0, "0123456789abcdef", "cam0"});
     }},
    {"/depth",
     "sensor_msgs/Image",
     [](Dialect d) {
       return RawImageMessage(d, {5, "16UC1", 2, 2, 4, "01234567", "cam0"});
     }},
    {"/info", "sensor_msgs/CameraInfo", [](Dialect d) { return CalibrationMessageOf(d, {}); }},
    {"/imu", "sensor_msgs/Imu", [](Dialect d) { return InertialMessageOf(d, 5, 0.1, 9.8); }},
    {"/clock", "rosgraph_msgs/Clock", ClockMessage},
    {"/tf", "tf2_msgs/TFMessage", TransformsMessage},
};

// What a topic is sent: empty, cut, of another encoding, with texts and lists that never end, and
// with 2^31 or noise at every place.
void Flood(dds_entity_t writer, const BrokenTopic& topic, Rng& rng) {
  for (const Dialect dialect : {Dialect::kCdr, Dialect::kBigEndianCdr}) {
    const std::string whole = topic.whole(dialect);
    for (const std::size_t size : {std::size_t{4}, std::size_t{8}, whole.size() / 2}) {
      Write(writer, whole.substr(0, size));
    }
    Write(writer, whole);
    for (const char encoding : {'\2', '\3', '\6', '\7', '\x7f'}) {
      std::string other = whole;
      other[1] = encoding;
      Write(writer, other);
    }
    Write(writer, WithEndlessText(dialect));
    Write(writer, WithEndlessPixels(dialect));
    for (std::size_t at = 4; at + 4 <= whole.size(); at += 4) {
      std::string lying = whole;
      for (std::size_t i = 0; i < 4; ++i) lying[at + i] = static_cast<char>(i == 3 ? 127 : 255);
      Write(writer, lying);
      for (std::size_t i = 0; i < 4; ++i) lying[at + i] = static_cast<char>(rng.Index(256));
      Write(writer, lying);
    }
  }
}

TEST(Ros2BrokenMessages, AreToldByOneLineATopicAndTakeNoMemory) {
  std::vector<std::string> arguments = {"image:=/rgb", "camera_info:=/info", "depth:=/depth"};
  for (const char* parameter : {"sensor:=rgbd",
                                "image_transport:=compressed",
                                "use_sim_time:=true",
                                "reliability:=reliable"}) {
    arguments.insert(arguments.end(), {"-p", parameter});
  }
  Ros2Node node(arguments);
  DdsPeer peer(Domain());
  std::vector<dds_entity_t> writers;
  for (const BrokenTopic& topic : kTopics) {
    writers.push_back(peer.MakeRawWriter("rt" + topic.name, DdsName(topic.type)));
  }
  for (const dds_entity_t writer : writers) {
    ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(writer); })) << node.Said();
  }
  const double before = MemoryOf(node.pid());
  Rng rng(1);
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    Flood(writers[i], kTopics[i], rng);
    dds_wait_for_acks(writers[i], DDS_SECS(5));
    const std::string said = "a message is left out: " + kTopics[i].name + ": expected a " +
                             kTopics[i].type + ", found ";
    EXPECT_TRUE(WaitUntil([&] { return node.Said().find(said) != std::string::npos; }))
        << said << node.Said();
  }
  EXPECT_LT(MemoryOf(node.pid()) - before, 20);
  EXPECT_EQ(node.Stop(), 0) << node.Said();
  // Every five seconds at most for each topic; the test takes less.
  for (const BrokenTopic& topic : kTopics) {
    EXPECT_LE(Count(node.Said(), "a message is left out: " + topic.name + ":"), 2) << node.Said();
  }
}

// The first fragment of an image that would be 2 GB, as DDS splits large ones
// (DDSI-RTPS 2.2, 8.3.7.3): no memory is taken for what has not come.
std::vector<std::uint8_t> FirstOfTwoGigabytes(dds_entity_t writer) {
  constexpr std::uint16_t kFragment = 1024;
  dds_guid_t guid;
  dds_get_guid(writer, &guid);
  std::vector<std::uint8_t> bytes = {'R', 'T', 'P', 'S', 2, 1, 1, 16};
  bytes.insert(bytes.end(), guid.v, guid.v + 12);
  const auto add = [&](std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  };
  add(0x16, 1);            // DATA_FRAG
  add(1, 1);               // little-endian
  add(32 + kFragment, 2);  // bytes that follow
  add(0, 2);
  add(28, 2);  // bytes to the data
  add(0, 4);   // any reader
  bytes.insert(bytes.end(), guid.v + 12, guid.v + 16);
  add(0, 4);
  add(1, 4);  // the first message of the writer
  add(1, 4);  // its first fragment
  add(1, 2);
  add(kFragment, 2);
  add(kEndless, 4);  // bytes of the whole
  bytes.resize(bytes.size() + kFragment);
  return bytes;
}

TEST(Ros2BrokenMessages, TakeNoMemoryForFragmentsThatDoNotCome) {
  Ros2Node node({"image:=/cam0/image_raw", "-p", "camera:=euroc"});
  DdsPeer peer(Domain());
  const auto images = peer.MakeRawWriter("rt/cam0/image_raw", DdsName("sensor_msgs/Image"));
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images); })) << node.Said();
  const double before = MemoryOf(node.pid());
  const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  const std::vector<std::uint8_t> fragment = FirstOfTwoGigabytes(images);
  for (const unsigned offset : {11U, 13U}) {  // where participants take what users send
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * Domain() + offset));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::sendto(
        sender, fragment.data(), fragment.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof(to));
  }
  ::close(sender);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_LT(MemoryOf(node.pid()) - before, 100);
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

// A publisher with the other byte order (CDR_BE) is as good.
TEST(Ros2BrokenMessages, ImagesOfBothByteOrdersGivePoses) {
  const auto sequence = FindData("euroc/MH_01_easy_first250");
  if (!sequence) GTEST_SKIP() << "the sequence is not there";
  const auto dataset = OpenDataset(*sequence, {});
  Ros2Node node(PairArguments());
  DdsPeer peer(Domain());
  const std::string type = DdsName("sensor_msgs/Image");
  const auto left = peer.MakeRawWriter("rt/cam0/image_raw", type);
  const auto right = peer.MakeRawWriter("rt/cam1/image_raw", type);
  const auto poses = peer.MakeReader("rt/plumbline/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  ASSERT_TRUE(WaitUntil([&] {
    return DdsPeer::HasReader(left) && DdsPeer::HasReader(right) && DdsPeer::HasWriter(poses);
  })) << node.Said();
  const auto publish = [](dds_entity_t writer, const GrayImage& image, std::int64_t stamp_ns) {
    std::string pixels;
    for (int y = 0; y < image.height(); ++y) {
      pixels.append(reinterpret_cast<const char*>(image.row(y)),
                    static_cast<std::size_t>(image.width()));
    }
    const auto width = static_cast<std::uint32_t>(image.width());
    const auto height = static_cast<std::uint32_t>(image.height());
    Write(writer,
          RawImageMessage(Dialect::kBigEndianCdr,
                          {stamp_ns, "mono8", width, height, width, pixels, "cam0"}));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = dataset->Read(i);
    ASSERT_TRUE(frame);
    publish(left, frame->left, frame->stamp_ns);
    publish(right, *frame->right, frame->stamp_ns);
    EXPECT_TRUE(WaitUntil([&] {
      return DdsPeer::Take<PoseStamped>(poses, [&](const PoseStamped& message) {
        EXPECT_EQ(StampOf(message.header), frame->stamp_ns);
      });
    })) << node.Said();
  }
  EXPECT_EQ(node.Stop(), 0) << node.Said();
}

}  // namespace ros2_broken_messages_test
}  // namespace plumbline
