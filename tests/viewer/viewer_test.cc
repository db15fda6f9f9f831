// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/viewer.h"

#include "plumbline/base/error.h"
#include "plumbline/io/recordings/recording_formats.h"
#include "plumbline/viewer/view_state.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include "tests/support/web_socket_client.h"
#include <atomic>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>
#if defined(__SANITIZE_ADDRESS__)
// GCC 12 has the function in its library, but no header for it.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace plumbline {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr unsigned kImage = 1, kUpdates = 8;  // channels

// AddressSanitizer keeps freed memory in its quarantine, so that the process grows under it; it
// knows what is in use.
double MegabytesInUse() {
#if defined(__SANITIZE_ADDRESS__)
  return static_cast<double>(__sanitizer_get_current_allocated_bytes()) / 1e6;
#else
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
#endif
}

// A run of made-up frames that shows itself.
// One camera has none; its lengths are no metres, which the page has to know.
TEST(ViewState, TellsTheBaselineOfTheCamera) {
  constexpr double kBaseline = 0.11;
  std::string field(9, '\x39');  // 7, of 8 bytes
  std::memcpy(field.data() + 1, &kBaseline, sizeof kBaseline);
  for (const double baseline : {kBaseline, 0.0}) {
    ViewedRun run;
    run.camera = TestCamera();
    run.camera.baseline = baseline;
    ViewState state(run);
    ViewCursor cursor;
    const SharedBytes update = state.Next(Stream::kUpdates, cursor, 0);
    ASSERT_NE(update, nullptr);
    EXPECT_EQ(update->find(field) != std::string::npos, baseline > 0);
  }
}

class Shown : public testing::Test {
 protected:
  Shown() {
    std::vector<Rigid3> poses(3);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].translation.x() = -0.2 * static_cast<double>(i);
    }
    made_ = MakeTrueMap(MakeSyntheticWorld(300, 40), poses, {});
    atlas_.Adopt(made_.map);
    atlas_.Activate(MapId{0});
  }

  void Open(ViewerOptions options = {}, const std::function<SharedBytes(ShownId)>& picture = {}) {
    if (!options.access) options.access = WebAccess();
    ViewedRun run;
    run.name = "made up";
    run.camera = TestCamera();
    run.can_pause = true;
    viewer_ = std::make_unique<Viewer>(options, run, SessionId{0}, picture);
    const std::string url = viewer_->url();
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.find(':', 5) + 1)));
  }

  // The next frame; every fifth is a keyframe.
  void Step() {
    FrameRecord record;
    record.id = FrameId{next_};
    record.stamp_ns = 1'000'000'000 + 50'000'000 * next_;
    record.status = FrameStatus::kTracked;
    record.keyframe = next_ % 5 == 0;
    record.times = {{"track", 3.5}, {"total", 20}};
    FrameView view;
    view.images.left = GrayImage(TestCamera().width, TestCamera().height, 77);
    view.frame = atlas_.active().keyframes().begin()->second.frame;
    viewer_->Show(record, view, {});
    if (viewer_->WantsMaps(record.keyframe)) viewer_->ReadMaps(atlas_, {});
    ++next_;
  }
  // Frames until the condition holds, at most ten seconds.
  template <class Condition>
  bool StepUntil(const Condition& holds) {
    for (int i = 0; i < 1000; ++i) {
      if (holds()) return true;
      Step();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return holds();
  }

  TrueMap made_;
  Atlas atlas_;
  std::unique_ptr<Viewer> viewer_;
  std::uint16_t port_ = 0;
  std::int64_t next_ = 0;
};

// Subscribes to one channel under the same number and counts what comes, in a thread of its own.
class Spectator {
 public:
  Spectator(std::uint16_t port, unsigned channel) : client_(port) {
    EXPECT_TRUE(client_.is_open()) << client_.head();
    client_.SendText(
        json{{"op", "subscribe"}, {"subscriptions", {{{"id", channel}, {"channelId", channel}}}}}
            .dump());
    thread_ = std::jthread([this] {
      while (auto message = client_.Receive()) {
        if (message->binary) {
          ++messages_;
        } else {
          ++texts_;
        }
      }
      ended_ = true;
    });
  }
  ~Spectator() { client_.socket().Shutdown(); }

  int messages() const { return messages_; }
  bool ended() const { return ended_; }

 private:
  WebSocketClient client_;
  std::atomic<int> messages_ = 0, texts_ = 0;
  std::atomic<bool> ended_ = false;
  std::jthread thread_;
};

// What comes until there is a binary message.
std::optional<std::string> NextData(WebSocketClient& client) {
  while (auto message = client.Receive()) {
    if (message->binary) return message->bytes;
  }
  return std::nullopt;
}

void SubscribeTo(WebSocketClient& client, unsigned channel) {
  client.SendText(
      json{{"op", "subscribe"}, {"subscriptions", {{{"id", 40}, {"channelId", channel}}}}}.dump());
}

TEST_F(Shown, ThePageIsServedToThisMachine) {
  Open();
  TestSocket socket(port_);
  socket.Send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string answer = socket.TakeUntil("</html>");
  EXPECT_THAT(answer, HasSubstr("200 OK"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy"));
  EXPECT_EQ(answer.find("{{"), std::string::npos);
}

TEST_F(Shown, AClientIsToldWhatThereIsAndGetsIt) {
  Open();
  WebSocketClient client(port_, {"/", "localhost", "", "foo, foxglove.websocket.v1"});
  ASSERT_TRUE(client.is_open());
  EXPECT_THAT(client.head(), HasSubstr("Sec-WebSocket-Protocol: foxglove.websocket.v1"));
  EXPECT_EQ(json::parse(client.Receive()->bytes)["op"], "serverInfo");
  EXPECT_EQ(json::parse(client.Receive()->bytes)["channels"].size(), kStreams);
  EXPECT_EQ(json::parse(client.Receive()->bytes)["services"].size(), 3U);
  Step();  // a keyframe, which is kept for those who come later
  SubscribeTo(client, kImage);
  const auto data = NextData(client);
  ASSERT_TRUE(data.has_value());
  EXPECT_EQ(data->substr(0, 5), std::string("\x01\x28\0\0\0", 5));
  EXPECT_THAT(*data, HasSubstr("jpeg"));
  EXPECT_THAT(*data, HasSubstr("\xff\xd8\xff"));  // where a JPEG file begins
}

TEST_F(Shown, NewerClientsGetTheNewerProtocol) {
  Open();
  WebSocketClient client(port_, {"/", "[::1]:80", "", "foxglove.websocket.v1,foxglove.sdk.v1"});
  EXPECT_THAT(client.head(), HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1"));
}

TEST_F(Shown, OthersAreRefused) {
  ViewerOptions options;
  options.access = WebAccess();
  options.access->token = "0123456789abcdef";
  options.access->origins = {"https://app.example"};
  Open(options);
  const std::string right = "/?token=0123456789abcdef";
  const std::string protocol = "foxglove.sdk.v1";
  EXPECT_TRUE(WebSocketClient(port_, {right, "localhost", "", protocol}).is_open());
  EXPECT_TRUE(
      WebSocketClient(port_, {right, "localhost", "https://app.example", protocol}).is_open());
  for (const Handshake& hello : {Handshake{"/", "localhost", "", protocol},
                                 Handshake{right, "evil.example", "", protocol},
                                 Handshake{right, "localhost", "http://evil.example", protocol}}) {
    EXPECT_THAT(WebSocketClient(port_, hello).head(), HasSubstr("403 Forbidden"));
  }
  EXPECT_THAT(WebSocketClient(port_, {right, "localhost", "", "chat"}).head(),
              HasSubstr("400 Bad Request"));
  TestSocket post(port_);
  post.Send("POST " + right + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n");
  EXPECT_THAT(post.TakeUntil("\r\n"), HasSubstr("405 Method Not Allowed"));
}

// Of two headers, one would be checked and the other believed.
TEST_F(Shown, RequestsWithTwoHostsAreRefused) {
  Open();
  for (const std::string twice : {"Host: localhost\r\nHost: localhost\r\n",
                                  "Host: localhost\r\nhost: evil.example\r\n",
                                  "Host: evil.example\r\nHost: localhost\r\n",
                                  "Host: localhost\r\nOrigin: a\r\nOrigin: b\r\n"}) {
    TestSocket get(port_);
    get.Send("GET / HTTP/1.1\r\n" + twice + "\r\n");
    EXPECT_THAT(get.TakeUntil("\r\n"), HasSubstr("400 Bad Request")) << twice;
  }
  TestSocket get(port_);
  get.Send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(get.TakeUntil("\r\n"), HasSubstr("200 OK"));
}

TEST_F(Shown, APortThatIsTakenIsBadInput) {
  Open();
  ViewerOptions options;
  options.access = WebAccess();
  options.access->port = port_;
  EXPECT_THROW(Viewer(options, {}, SessionId{0}), InputError);
}

TEST_F(Shown, TwentyLookAtOnce) {
  Open();
  std::vector<std::unique_ptr<Spectator>> all;
  for (int i = 0; i < 20; ++i) all.push_back(std::make_unique<Spectator>(port_, kUpdates));
  EXPECT_TRUE(StepUntil([&] {
    return std::all_of(all.begin(), all.end(), [](const auto& s) { return s->messages() >= 5; });
  }));
}

TEST_F(Shown, WhoeverNeverReadsKeepsNobodyWaiting) {
  Open();
  WebSocketClient lazy(port_);
  SubscribeTo(lazy, kImage);
  Spectator other(port_, kImage);
  StepUntil([&] { return other.messages() > 0; });
  const double before = MegabytesInUse();
  const auto start = std::chrono::steady_clock::now();
  const int seen = other.messages();
  StepUntil([&] { return other.messages() >= seen + 50; });
  EXPECT_GE(other.messages(), seen + 50);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_LT(MegabytesInUse(), before + 48);
}

TEST_F(Shown, AKilledClientIsForgotten) {
  Open();
  for (int i = 0; i < 20; ++i) {
    WebSocketClient client(port_);
    SubscribeTo(client, kUpdates);
    Step();
  }  // gone without a word
  Spectator other(port_, kUpdates);
  EXPECT_TRUE(StepUntil([&] { return other.messages() >= 5; }));
}

TEST_F(Shown, GarbageHarmsNobody) {
  Open();
  Rng rng(3, "garbage");
  for (int i = 0; i < 50; ++i) {
    std::string bytes;
    for (int n = 0; n < 2000; ++n) bytes += static_cast<char>(rng.Next());
    TestSocket raw(port_);
    raw.Send(bytes + "\r\n\r\n");
    WebSocketClient framed(port_);
    framed.SendText(bytes);
    framed.SendBinary(bytes);
    framed.SendText(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99}]})");
    framed.socket().Send(bytes);  // no frames
  }
  TestSocket endless(port_);
  endless.Send("GET /" + std::string(20'000, 'a'));
  EXPECT_TRUE(endless.IsClosedByPeer());
  Spectator other(port_, kUpdates);
  EXPECT_TRUE(StepUntil([&] { return other.messages() >= 5; }));
  EXPECT_FALSE(viewer_->TakeFailure().has_value());
}

TEST_F(Shown, TenThousandConnectionsLeaveNothing) {
  Open();
  // An allocator keeps freed memory back. These connections fill that room, so that memory which
  // grows afterwards is a leak.
  for (int i = 0; i < 5'000; ++i) TestSocket socket(port_);
  const double before = MegabytesInUse();
  for (int i = 0; i < 10'000; ++i) {
    TestSocket socket(port_);
    if (i % 10 == 0) socket.Send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  Spectator other(port_, kUpdates);
  EXPECT_TRUE(StepUntil([&] { return other.messages() >= 5; }));
// ThreadSanitizer keeps memory for everything that happened, so the process grows under it.
#if !defined(__SANITIZE_THREAD__)
  EXPECT_LT(MegabytesInUse(), before + 32);
#else
  EXPECT_GT(before, 0);
#endif
}

TEST_F(Shown, OnlySoManyConnectAtOnce) {
  Open();
  std::vector<std::unique_ptr<TestSocket>> idle;
  for (std::size_t i = 0; i < WebServer::kMostConnections; ++i) {
    idle.push_back(std::make_unique<TestSocket>(port_));
  }
  TestSocket late(port_);
  EXPECT_TRUE(late.IsClosedByPeer());
  idle.clear();
  // The server needs a moment to notice that they are gone.
  EXPECT_TRUE(StepUntil([&] { return WebSocketClient(port_).is_open(); }));
  Spectator other(port_, kUpdates);
  EXPECT_TRUE(StepUntil([&] { return other.messages() >= 1; }));
}

void Call(WebSocketClient& client, unsigned service, const std::string& request) {
  std::string bytes(13, '\0');
  bytes[0] = 2;
  bytes[1] = static_cast<char>(service);
  bytes[5] = 77;
  bytes[9] = 4;
  client.SendBinary(bytes + "json" + request);
}

TEST_F(Shown, ARunIsPausedSteppedAndGoesOnWhenNobodyLooks) {
  Open();
  EXPECT_FALSE(viewer_->HoldsBack());
  {
    WebSocketClient client(port_);
    SubscribeTo(client, kUpdates);
    Call(client, 2, R"({"paused": true})");
    while (true) {
      const auto answer = NextData(client);
      ASSERT_TRUE(answer.has_value());
      if ((*answer)[0] == 3) break;
    }
    EXPECT_TRUE(viewer_->HoldsBack());
    Call(client, 3, "{}");
    while ((*NextData(client))[0] != 3) {
    }
    EXPECT_FALSE(viewer_->HoldsBack());
    EXPECT_TRUE(viewer_->HoldsBack());
  }
  EXPECT_TRUE(StepUntil([&] { return !viewer_->HoldsBack(); }));
}

TEST_F(Shown, AnswersWhoSeesALandmark) {
  Open();
  WebSocketClient client(port_);
  Call(client, 1, R"({"point": 3})");
  int steps = 0;
  StepUntil([&] { return ++steps > 30; });
  const auto answer = NextData(client);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->substr(0, 9), std::string("\x03\x01\0\0\0\x4d\0\0\0", 9));
  EXPECT_EQ(json::parse(answer->substr(17))["point"], 3);
  Call(client, 1, "{}");
  while (const auto message = client.Receive()) {
    if (!message->binary && json::parse(message->bytes)["op"] == "serviceCallFailure") return;
  }
  FAIL() << "no failure was told";
}

// The maps may be looked at twice while the thread of the viewer has something else to do.
TEST_F(Shown, AnswersThatTheServerHasNotTakenYetAreKept) {
  std::promise<void> busy, go_on;
  Open({}, [&busy, released = go_on.get_future().share()](ShownId) {
    busy.set_value();
    released.wait();
    return SharedBytes();
  });
  WebSocketClient client(port_);
  Call(client, 1, R"({"point": 3})");
  bool asked = false;
  for (int i = 0; i < 1000 && !asked; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    asked = viewer_->WantsMaps(false);
  }
  ASSERT_TRUE(asked);
  Call(client, 1, R"({"point": 4})");
  Call(client, 9, "{}");  // there is no such service, which is told behind the question
  std::optional<WebSocketClient::Message> text = client.Receive();
  while (text && json::parse(text->bytes)["op"] != "serviceCallFailure") text = client.Receive();
  ASSERT_TRUE(text.has_value());
  TestSocket socket(port_);
  socket.Send("GET /keyframe/12345 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_EQ(busy.get_future().wait_for(std::chrono::seconds(10)), std::future_status::ready);
  viewer_->ReadMaps(atlas_, {});
  viewer_->ReadMaps(atlas_, {});  // as a question asks for that comes while the maps are looked at
  go_on.set_value();
  for (const int point : {3, 4}) {
    const auto answer = NextData(client);
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(json::parse(answer->substr(17))["point"], point);
  }
}

TEST_F(Shown, MoreQuestionsThanCanWaitAreRefused) {
  Open();
  WebSocketClient client(port_);
  for (int point = 0; point < 65; ++point) Call(client, 1, R"({"point": 3})");
  std::optional<WebSocketClient::Message> text = client.Receive();
  while (text && json::parse(text->bytes)["op"] != "serviceCallFailure") text = client.Receive();
  ASSERT_TRUE(text.has_value());
  EXPECT_THAT(text->bytes, HasSubstr("too many questions"));
}

TEST_F(Shown, KeyframesAreKeptWithTheirImages) {
  Open();
  Spectator watcher(port_, kUpdates);
  ASSERT_TRUE(StepUntil([&] { return watcher.messages() >= 3 && next_ > 10; }));
  TestSocket socket(port_);
  socket.Send("GET /keyframe/0 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(socket.TakeUntil("\xff\xd8\xff"), HasSubstr("200 OK"));
  TestSocket other(port_);
  other.Send("GET /keyframe/0x HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(other.TakeUntil("\r\n"), HasSubstr("404"));
}

TEST_F(Shown, NobodyIsCopiedForWhoDoesNotLook) {
  Open();
  for (int i = 0; i < 10; ++i) Step();
  EXPECT_FALSE(viewer_->WantsMaps(true));
}

TEST_F(Shown, TheEndIsTold) {
  Open();
  Spectator watcher(port_, kUpdates);
  ASSERT_TRUE(StepUntil([&] { return watcher.messages() >= 2; }));
  viewer_->Finish(atlas_, {});
  viewer_.reset();
  for (int i = 0; i < 500 && !watcher.ended(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(watcher.ended());
}

// The same channels in a file, of every frame, which our own reader understands.
TEST_F(Shown, ARecordingHasEveryFrame) {
  const ScratchFolder folder;
  ViewerOptions options;
  options.record = folder / "run.mcap";
  options.record_all = true;
  Open(options);
  constexpr int kFrames = 40;
  for (int i = 0; i < kFrames; ++i) Step();
  viewer_->Finish(atlas_, {});
  EXPECT_FALSE(viewer_->TakeFailure().has_value());
  EXPECT_FALSE(viewer_->RecordingFailure().has_value());
  viewer_.reset();
  std::map<std::string, int> counts;
  ReadMcap(*options.record, [&](const Channel& channel, const StoredMessage&, auto) {
    EXPECT_EQ(channel.encoding, "protobuf");
    ++counts[channel.topic];
  });
  EXPECT_EQ(counts["/camera/image"], kFrames);
  EXPECT_EQ(counts["/camera/calibration"], kFrames);
  EXPECT_EQ(counts["/camera/annotations"], kFrames);
  EXPECT_EQ(counts["/tf"], kFrames);
  EXPECT_EQ(counts["/camera/pose"], kFrames);
  EXPECT_GE(counts["/map/points"], 1);
  EXPECT_EQ(counts["/map/lines"], 1);
  EXPECT_GE(counts["/plumbline/updates"], kFrames);
}

// JPEG files have sides of at most 65500 pixels.
TEST(ViewState, ShowsFramesWhoseImageIsTooLongWithoutIt) {
  EXPECT_NE(JpegOf(GrayImage(65'500, 1)), "");
  EXPECT_EQ(JpegOf(GrayImage(65'501, 1)), "");
  EXPECT_EQ(JpegOf(GrayImage(1, 65'501)), "");
  ViewedFrame frame;
  frame.record.id = FrameId{0};
  frame.record.keyframe = true;
  frame.image = GrayImage(65'501, 1);
  ViewState state{ViewedRun{}};
  state.Take(std::move(frame));
  ViewCursor cursor;
  EXPECT_EQ(state.Next(Stream::kImage, cursor, 0), nullptr);
  EXPECT_NE(state.Next(Stream::kUpdates, cursor, 0), nullptr);
}

TEST(ViewState, ShowsBothImagesOfAPair) {
  for (const bool pair : {true, false}) {
    ViewedRun run;
    run.camera = TestCamera();
    ViewState state{run};
    ViewedFrame frame;
    frame.record.id = FrameId{0};
    frame.image = GrayImage(64, 48, 90);
    if (pair) frame.right = GrayImage(64, 48, 200);
    state.Take(std::move(frame));
    ViewCursor cursor;
    const SharedBytes left = state.Next(Stream::kImage, cursor, 0);
    const SharedBytes right = state.Next(Stream::kRightImage, cursor, 0);
    const SharedBytes camera = state.Next(Stream::kRightCalibration, cursor, 0);
    ASSERT_NE(left, nullptr);
    ASSERT_EQ(right != nullptr, pair);
    ASSERT_EQ(camera != nullptr, pair);
    if (!pair) continue;
    EXPECT_THAT(*right, HasSubstr("\xff\xd8\xff"));
    EXPECT_NE(*right, *left);
    EXPECT_EQ(state.Next(Stream::kRightImage, cursor, 0), nullptr);
  }
}

TEST_F(Shown, ARecordingThatCannotBeWrittenIsBadInput) {
  ViewerOptions options;
  options.record = "/no/such/folder/run.mcap";
  EXPECT_THROW(Viewer(options, {}, SessionId{0}), InputError);
}

}  // namespace
}  // namespace plumbline
