// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "dds_peer.h"
#include "messages.h"
#include "mono_node_test.h"
#include "ros2_node.h"
#include "tests/support/message_writer.h"
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace ros2_services_test {

using testing::HasSubstr;
using Reply = std_srvs_srv_dds__Trigger_Response_;
using Ros2ServicesTest = MonoNodeTest;

constexpr const char* kRequestType = "std_srvs::srv::dds_::Trigger_Request_";
constexpr const char* kReplyType = "std_srvs::srv::dds_::Trigger_Response_";
constexpr std::uint32_t kLow = 0x01020304, kHigh = 0x05060708;
constexpr std::uint64_t kClient = (std::uint64_t{kHigh} << 32) | kLow;

// The request of rmw_fastrtps, which DDS itself tells from others, and of rmw_cyclonedds.
std::vector<std::uint8_t> FastRequest() { return {0, 1, 0, 0, 0, 0, 0, 0}; }
std::vector<std::uint8_t> CycloneRequest(Dialect dialect, std::uint32_t number) {
  RosFields fields(dialect);
  const bool little = dialect == Dialect::kCdr;
  fields.U32(little ? kLow : kHigh);
  fields.U32(little ? kHigh : kLow);
  fields.U32(little ? number : 0);
  fields.U32(little ? 0 : number);
  fields.U8(0);
  const std::string bytes = fields.Take();
  return {bytes.begin(), bytes.end()};
}

// A client of a service of the node.
template <class Message>
class Client {
 public:
  Client(DdsPeer& peer, const std::string& service, const dds_topic_descriptor_t& type)
      : requests_(peer.MakeRawWriter("rq/plumbline/" + service + "Request", kRequestType)),
        replies_(peer.MakeReaderNamed("rr/plumbline/" + service + "Reply", type, kReplyType)) {
    found_ =
        WaitUntil([&] { return DdsPeer::HasReader(requests_) && DdsPeer::HasWriter(replies_); });
  }

  bool found() const { return found_; }
  void Send(const std::vector<std::uint8_t>& request) { dds_write(requests_, &request); }
  // Sends a request; hands its reply to `use`.
  bool Call(const std::vector<std::uint8_t>& request,
            const std::function<void(const Message&)>& use) {
    Send(request);
    return WaitUntil([&] { return DdsPeer::Take<Message>(replies_, use); });
  }

 private:
  dds_entity_t requests_, replies_;
  bool found_ = false;
};

TEST_F(Ros2ServicesTest, SaveLoadAndReset) {
  const ScratchFolder folder;
  const std::string map = (folder / "map.plb").string();
  DdsPeer peer(Domain());
  Ros2Node node(MonoArguments(
      {"-p", "base_frame:=cam0", "-p", "reliability:=reliable", "-p", "map_file:=" + map}));
  const auto images = MakeImageWriter(peer, "rt/cam0/image_raw");
  const auto state = peer.MakeReader("rt/plumbline/state", std_msgs_msg_dds__String__desc);
  Client<Reply> save(peer, "save_map", std_srvs_srv_dds__Trigger_Response__desc);
  Client<Reply> load(peer, "load_map", std_srvs_srv_dds__Trigger_Response__desc);
  Client<CycloneReply> reset(peer, "reset", CycloneReply_desc);
  ASSERT_TRUE(save.found() && load.found() && reset.found()) << node.Said();
  ASSERT_TRUE(WaitUntil([&] { return DdsPeer::HasReader(images) && DdsPeer::HasWriter(state); }));

  EXPECT_TRUE(save.Call(FastRequest(), [&](const Reply& reply) {
    EXPECT_FALSE(reply.success);
    EXPECT_EQ(reply.message, map + ": expected frames before a map is saved, found none");
  })) << node.Said();

  bool tracked = false;
  std::size_t index = 0;
  ASSERT_TRUE(WaitUntil([&] {
    Publish(images, index++ % dataset_->size());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    DdsPeer::Take<std_msgs_msg_dds__String_>(
        state, [&](const auto& message) { tracked = message.data == std::string("tracked"); });
    return tracked;
  })) << node.Said();
  EXPECT_TRUE(save.Call(FastRequest(), [&](const Reply& reply) {
    EXPECT_TRUE(reply.success) << reply.message;
    EXPECT_THAT(reply.message, HasSubstr(map + ": "));
    EXPECT_THAT(reply.message, HasSubstr(" keyframes, "));
  })) << node.Said();
  EXPECT_TRUE(std::filesystem::exists(map));
  EXPECT_TRUE(load.Call(FastRequest(), [&](const Reply& reply) {
    EXPECT_TRUE(reply.success) << reply.message;
    EXPECT_THAT(reply.message, HasSubstr("the camera is looked for, and the map goes on"));
  })) << node.Said();

  // The reply has the header of the request, in the node's own byte order.
  for (const auto& [dialect, number] :
       {std::pair{Dialect::kCdr, 7}, std::pair{Dialect::kBigEndianCdr, 8}}) {
    const auto request = CycloneRequest(dialect, static_cast<std::uint32_t>(number));
    EXPECT_TRUE(reset.Call(request, [&](const CycloneReply& reply) {
      EXPECT_EQ(reply.client, kClient);
      EXPECT_EQ(reply.request, number);
      EXPECT_TRUE(reply.success);
      EXPECT_THAT(reply.message, HasSubstr("the maps are gone"));
    })) << node.Said();
  }
  // No request: it is told, and the next one is answered.
  reset.Send({0, 1, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_TRUE(reset.Call(CycloneRequest(Dialect::kCdr, 9), [&](const CycloneReply& reply) {
    EXPECT_EQ(reply.request, 9);
  })) << node.Said();
  EXPECT_EQ(node.Stop(), 0) << node.Said();
  EXPECT_THAT(node.Said(),
              HasSubstr("rq/plumbline/resetRequest: expected a std_srvs/Trigger_Request, found 12 "
                        "bytes that are none"));
}

}  // namespace ros2_services_test
}  // namespace plumbline
