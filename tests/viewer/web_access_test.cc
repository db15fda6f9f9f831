// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/web_access.h"

#include "plumbline/base/error.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(WebAccess, AddressesAreAPortOrAHostAndAPort) {
  EXPECT_EQ(ParseWebAddress("--view", "8080").host, "127.0.0.1");
  EXPECT_EQ(ParseWebAddress("--view", "8080").port, 8080);
  EXPECT_EQ(ParseWebAddress("--view", "0.0.0.0:1").host, "0.0.0.0");
  EXPECT_EQ(ParseWebAddress("--view", "[::1]:65535").host, "::1");
  EXPECT_EQ(ParseWebAddress("--view", "robot-2.local:0").host, "robot-2.local");
}

TEST(WebAccess, OtherAddressesAreRefused) {
  for (const char* text : {"",
                           "x",
                           ":80",
                           "65536",
                           "-1",
                           "80 ",
                           "a:b",
                           "::1:80",
                           "[::1:80",
                           "a b:80",
                           "http://a:80"}) {
    EXPECT_THROW(ParseWebAddress("--view", text), InputError) << text;
  }
}

TEST(WebAccess, OriginsAreSchemeAndHost) {
  for (const char* text : {"https://app.example", "http://localhost:8080", "file://", "null"}) {
    EXPECT_EQ(ParseWebOrigin("--view-origin", text), text);
  }
  for (const char* text : {"", "app.example", "https://", "https://a/", "https://a b", "://a"}) {
    EXPECT_THROW(ParseWebOrigin("--view-origin", text), InputError) << text;
  }
}

TEST(WebAccess, KnowsWhatOnlyThisMachineReaches) {
  for (const char* host : {"localhost", "127.0.0.1", "127.1.2.3", "::1", "LocalHost"}) {
    EXPECT_TRUE(IsLoopback(host)) << host;
  }
  for (const char* host : {"0.0.0.0", "127.0.0.1.example", "::", "10.0.0.1", "robot"}) {
    EXPECT_FALSE(IsLoopback(host)) << host;
  }
}

TEST(WebAccess, TokensAreLongAndDiffer) {
  const std::string token = MakeWebToken();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, MakeWebToken());
}

std::string Refusal(const WebAccess& access, const WebRequestHead& head) {
  return WhyRefused(access, head, "robot").value_or("");
}

// A page of somebody else whose name was made to mean this machine.
TEST(WebAccess, HostsMustMeanThisMachine) {
  const WebAccess access;
  for (const char* host : {"localhost",
                           "localhost:8080",
                           "127.0.0.1:8080",
                           "[::1]:8080",
                           "10.0.0.7:8080",
                           "robot",
                           "ROBOT.local:8080"}) {
    EXPECT_EQ(Refusal(access, {"/", host, ""}), "") << host;
  }
  for (const char* host : {"",
                           "evil.example",
                           "evil.example:8080",
                           "127.0.0.1.evil.example",
                           "localhost.evil.example",
                           "1.2.3.4.5",
                           "[evil",
                           "robotx"}) {
    EXPECT_EQ(Refusal(access, {"/", host, ""}), "unknown host") << host;
  }
  WebAccess named;
  named.host = "viewer.lab.example";
  EXPECT_EQ(Refusal(named, {"/", "viewer.lab.example:80", ""}), "");
}

TEST(WebAccess, OriginsMustBeKnown) {
  WebAccess access;
  access.origins = {"https://app.example"};
  EXPECT_EQ(Refusal(access, {"/", "localhost:1", ""}), "");
  EXPECT_EQ(Refusal(access, {"/", "localhost:1", "http://localhost:1"}), "");
  EXPECT_EQ(Refusal(access, {"/", "localhost:1", "https://app.example"}), "");
  for (const char* origin : {"http://localhost:2",
                             "https://localhost:1",
                             "https://app.example.evil",
                             "null",
                             "http://evil.example"}) {
    EXPECT_EQ(Refusal(access, {"/", "localhost:1", origin}), "unknown origin") << origin;
  }
}

TEST(WebAccess, TokensMustBeRight) {
  WebAccess access;
  access.token = "0123456789abcdef";
  EXPECT_EQ(Refusal(access, {"/?token=0123456789abcdef", "localhost", ""}), "");
  EXPECT_EQ(Refusal(access, {"/x?a=b&token=0123456789abcdef", "localhost", ""}), "");
  for (const char* target : {"/",
                             "/?token=",
                             "/?token=0123456789abcdee",
                             "/?token=0123456789abcdefg",
                             "/?xtoken=0123456789abcdef",
                             "/token=0123456789abcdef"}) {
    EXPECT_NE(Refusal(access, {target, "localhost", ""}), "") << target;
  }
}

TEST(WebAccess, PathsAreWithoutQuery) {
  EXPECT_EQ(PathOf("/keyframe/3?token=a"), "/keyframe/3");
  EXPECT_EQ(PathOf("/"), "/");
}

}  // namespace
}  // namespace plumbline
