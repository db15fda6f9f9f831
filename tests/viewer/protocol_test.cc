// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/protocol.h"

#include <string>
#include <variant>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using nlohmann::json;

TEST(Protocol, TellsWhoServesAndWhat) {
  const json info = json::parse(ServerInfoText("a run", "7"));
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["sessionId"], "7");
  EXPECT_EQ(info["capabilities"], json({"services"}));

  const json advertise = json::parse(AdvertiseText(FoxgloveChannels(), "abc"));
  ASSERT_EQ(advertise["channels"].size(), kStreams);
  const json& image = advertise["channels"][0];
  EXPECT_EQ(image["id"], 1);
  EXPECT_EQ(image["topic"], "/camera/image");
  EXPECT_EQ(image["encoding"], "protobuf");
  EXPECT_EQ(image["schemaName"], "foxglove.CompressedImage");
  EXPECT_EQ(image["schema"], "YWJj");
}

TEST(Protocol, NamesThatAreNoTextAreRepaired) {
  EXPECT_NO_THROW(json::parse(ServerInfoText("\xff\xfe", "1")));
}

TEST(Protocol, MessageDataBeginsWithSubscriptionAndTime) {
  const std::string head = MessageDataHead(0x01020304, 0x1122334455667788);
  EXPECT_EQ(head, std::string("\x01\x04\x03\x02\x01\x88\x77\x66\x55\x44\x33\x22\x11"));
}

TEST(Protocol, UnderstandsSubscriptions) {
  const auto message = ParseClientText(
      R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":1},{"id":6,"channelId":8}]})");
  ASSERT_TRUE(message.has_value());
  const auto& subscribe = std::get<Subscribe>(*message);
  ASSERT_EQ(subscribe.subscriptions.size(), 2U);
  EXPECT_EQ(subscribe.subscriptions[1].id, 6U);
  EXPECT_EQ(subscribe.subscriptions[1].channel, 8U);
  const auto gone = ParseClientText(R"({"op":"unsubscribe","subscriptionIds":[5]})");
  ASSERT_TRUE(gone.has_value());
  EXPECT_EQ(std::get<Unsubscribe>(*gone).ids, std::vector<std::uint32_t>{5});
}

TEST(Protocol, UnderstandsCallsOfServices) {
  std::string call("\x02\x03\0\0\0\x09\0\0\0\x04\0\0\0json{}", 19);
  const auto message = ParseClientBinary(call);
  ASSERT_TRUE(message.has_value());
  const auto& service = std::get<ServiceCall>(*message);
  EXPECT_EQ(service.service, 3U);
  EXPECT_EQ(service.call, 9U);
  EXPECT_EQ(service.json, "{}");
  // An answer has the same form.
  std::string answer = ServiceAnswer(3, 9, "{}");
  answer[0] = 2;
  EXPECT_EQ(answer, call);
}

TEST(Protocol, WhatIsNotOfferedHasAName) {
  const auto message = ParseClientText(R"({"op":"advertise","channels":[]})");
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(std::get<NotOffered>(*message).what, "advertise");
  EXPECT_TRUE(std::holds_alternative<NotOffered>(*ParseClientBinary("\x01 message")));
}

TEST(Protocol, RefusesWhatIsNoMessage) {
  for (const char* text :
       {"",
        "hello",
        "[]",
        "{}",
        R"({"op":3})",
        R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":[1]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1e99}]})",
        R"({"op":"subscribe","subscriptions":[{"id":99999999999,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":["a"]})"}) {
    EXPECT_FALSE(ParseClientText(text).has_value()) << text;
  }
  const std::string long_name("\x02\x01\0\0\0\x01\0\0\0\xff\xff\xff\xff{}", 15);
  EXPECT_FALSE(ParseClientBinary(long_name).has_value());
  EXPECT_FALSE(ParseClientBinary("").has_value());
  EXPECT_FALSE(ParseClientBinary("\x02\x01").has_value());
  EXPECT_FALSE(ParseClientBinary("\x07").has_value());
}

}  // namespace
}  // namespace plumbline
