// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_run.h"
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/e2e/same_run.h"
#include "tests/support/free_port.h"
#include "tests/support/web_socket_client.h"
#include <chrono>
#include <csignal>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace plumbline {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// As soon as somebody listens, at most half a minute.
std::optional<WebSocketClient> ConnectTo(std::uint16_t port) {
  for (int i = 0; i < 3000; ++i) {
    try {
      return WebSocketClient(port);
    } catch (const std::runtime_error&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return std::nullopt;
}

void SubscribeToAll(WebSocketClient& client) {
  json subscriptions = json::array();
  for (int i = 1; i <= 8; ++i) subscriptions.push_back({{"id", i}, {"channelId", i}});
  client.SendText(json{{"op", "subscribe"}, {"subscriptions", subscriptions}}.dump());
}

void Call(WebSocketClient& client, char service, const std::string& request) {
  std::string bytes(13, '\0');
  bytes[0] = 2;
  bytes[1] = service;
  bytes[9] = 4;
  client.SendBinary(bytes + "json" + request);
}

int ExitCodeOf(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Somebody looks at everything, pauses, steps and goes.
TEST(View, ARunThatIsWatchedHasTheSameResults) {
  const ScratchFolder folder;
  const std::uint16_t port = FreePort();
  const std::filesystem::path out = folder / "out";
  const pid_t child = StartProgram(
      {"run", Posters().sequence.string(), "--view", std::to_string(port), "--out", out.string()});
  {
    auto client = ConnectTo(port);
    ASSERT_TRUE(client.has_value());
    SubscribeToAll(*client);
    Call(*client, 2, R"({"paused": true})");
    bool paused = false, went_on = false;
    int data = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto message = client->Receive();
      if (!message) break;
      if (!message->binary) continue;
      if (message->bytes[0] == 1) {
        ++data;
        continue;
      }
      // Steps as long as they are answered, then on.
      if (!paused) {
        paused = true;
        Call(*client, 1, R"({"point": 1})");
        Call(*client, 3, "{}");
        Call(*client, 3, "{}");
      } else if (!went_on) {
        went_on = true;
        Call(*client, 2, R"({"paused": false})");
      }
    }
    EXPECT_TRUE(went_on);
    EXPECT_GT(data, 10);
  }
  EXPECT_EQ(ExitCodeOf(child), 0);
  ExpectSameResults(Posters().out, out);
}

// Whoever is killed takes nobody along.
TEST(View, ARunOutlivesThoseWhoWatch) {
  const ScratchFolder folder;
  const std::uint16_t port = FreePort();
  const pid_t child = StartProgram({"run",
                                    Posters().sequence.string(),
                                    "--view",
                                    std::to_string(port),
                                    "--out",
                                    (folder / "out").string()});
  {
    auto client = ConnectTo(port);
    ASSERT_TRUE(client.has_value());
    SubscribeToAll(*client);
    EXPECT_TRUE(client->Receive().has_value());
  }
  EXPECT_EQ(ExitCodeOf(child), 0);
  ExpectSameResults(Posters().out, folder / "out");
}

TEST(View, ARecordingIsInputForTheNextRun) {
  const ScratchFolder folder;
  const std::string recording = Quoted(folder / "run.mcap");
  const Outcome first = RunProgram(folder,
                                   "run " + Quoted(Posters().sequence) + " --record " + recording +
                                       " --out " + Quoted(folder / "first"));
  ASSERT_EQ(first.code, 0) << first.err;
  ExpectSameResults(Posters().out, folder / "first");
  const Outcome second =
      RunProgram(folder, "run " + recording + " --out " + Quoted(folder / "second"));
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(Contents(folder / "second" / "frames.csv"), HasSubstr("\n23,"));
  // The file that is read is not to be replaced.
  const Outcome third = RunProgram(folder,
                                   "run " + recording + " --sensor mono --record " + recording +
                                       " --out " + Quoted(folder / "third"));
  EXPECT_EQ(third.code, 2);
  EXPECT_THAT(third.err, HasSubstr("expected another file than one that is read"));
}

// What a run that was killed had recorded is kept, by the same command too.
TEST(View, ThePartOfARecordingReplacesNothing) {
  const ScratchFolder folder;
  const std::filesystem::path record = folder / "run.mcap", part = folder / "run.mcap.part";
  const std::string to = " --to 3 --record " + Quoted(record) + " --out " + Quoted(folder / "out");
  const std::string poster = "run " + Quoted(Posters().sequence) + to;
  ASSERT_EQ(RunProgram(folder, poster).code, 0);
  std::filesystem::rename(record, part);
  const std::string recorded = Contents(part);
  Outcome outcome = RunProgram(folder, "run " + Quoted(part) + " --format mcap --sensor mono" + to);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("expected another file than one that is read"));
  EXPECT_TRUE(Contents(part) == recorded);
  outcome = RunProgram(folder, poster + " --quiet");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err,
            "plumbline: " + record.string() +
                ": an earlier run did not complete it; what it had recorded is in " +
                part.string() + "-1\n");
  EXPECT_TRUE(Contents(part.string() + "-1") == recorded);
  // One that cannot listen has nothing to record.
  const std::string complete = Contents(record);
  outcome = RunProgram(folder, poster + " --view 192.0.2.1:80");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(Contents(record) == complete);
  EXPECT_FALSE(std::filesystem::exists(part));
  folder.Write("run.mcap.part", "mine");
  outcome = RunProgram(folder, poster);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr(part.string() + ": expected nothing, or a recording"));
  EXPECT_EQ(Contents(part), "mine");
}

// A new client gets a message that is large enough for a map, as one of the first `messages`.
void ExpectToShowAMap(std::uint16_t port, int messages) {
  auto client = ConnectTo(port);
  ASSERT_TRUE(client.has_value());
  SubscribeToAll(*client);
  std::size_t largest = 0;
  for (int i = 0; i < messages && largest < 10'000; ++i) {
    const auto message = client->Receive();
    ASSERT_TRUE(message.has_value());
    if (message->binary) largest = std::max(largest, message->bytes.size());
  }
  EXPECT_GE(largest, 10'000U);
}

TEST(View, ASavedMapIsShown) {
  const std::uint16_t port = FreePort();
  const pid_t child =
      StartProgram({"map", "view", Posters().map.string(), "--view", std::to_string(port)});
  ExpectToShowAMap(port, 10);
  TestSocket picture(port);
  picture.Send("GET /keyframe/0 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(picture.TakeUntil("\r\n"), HasSubstr("200 OK"));
  ::kill(child, SIGINT);
  EXPECT_EQ(ExitCodeOf(child), 0);
}

// The view of a finished run stays until somebody ends it, which is no interruption of the run.
TEST(View, AFinishedRunIsShownUntilItIsEnded) {
  const ScratchFolder folder;
  const std::uint16_t port = FreePort();
  const std::filesystem::path out = folder / "out";
  const pid_t child = StartProgram({"run",
                                    Posters().sequence.string(),
                                    "--view",
                                    std::to_string(port),
                                    "--stay",
                                    "--out",
                                    out.string()});
  ASSERT_TRUE(WaitForFile(out / "report.html"));
  for (int i = 0; i < 2; ++i) ExpectToShowAMap(port, 20);  // for whoever comes later, too
  ::kill(child, SIGINT);
  EXPECT_EQ(ExitCodeOf(child), 0);
  ExpectSameResults(Posters().out, out);
}

struct BadOptions {
  std::string arguments, message;
};

TEST(View, BadOptionsAreNamed) {
  const ScratchFolder folder;
  const std::vector<BadOptions> table = {
      {"--view x", "--view: expected [HOST:]PORT"},
      {"--view 0.0.0.0:0 --quiet", "would not tell the address with its token"},
      {"--view 192.0.2.1:80", "cannot listen there"},
      {"--view-origin https://a", "--view-origin: expected --view"},
      {"--stay", "--stay: expected --view"},
      {"--view 0 --view-origin a", "--view-origin: expected the origin of a page"},
      {"--record /no/such/folder/a.mcap",
       "/no/such/folder/a.mcap.part: No such file or directory"}};
  for (const BadOptions& bad : table) {
    const Outcome outcome = RunProgram(folder,
                                       "run " + Quoted(Posters().sequence) + " " + bad.arguments +
                                           " --out " + Quoted(folder / "out"));
    EXPECT_EQ(outcome.code, 2) << bad.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(bad.message));
  }
}

}  // namespace
}  // namespace plumbline
