// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "ros/make_node.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/message_writer.h"
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

class NoPublication : public Publication {
 public:
  void Publish(const Bytes&) override {}
  bool HasSubscribers() const override { return false; }
};

// Nothing comes; time passes when the test says so.
class SilentTransport : public Transport {
 public:
  bool UsesCdr() const override { return true; }
  std::string Resolve(const std::string& name) const override { return "/" + name; }
  void Subscribe(const TopicSettings& topic, Receive receive) override {
    receivers[topic.name] = std::move(receive);
  }
  void Repeat(double, std::function<void()>) override {}
  void After(double, std::function<void()> work) override { later.push_back(std::move(work)); }
  bool HasPublisher(const std::string& topic) const override { return published.count(topic) > 0; }
  void OfferTrigger(const std::string&, std::function<std::string()>) override {}
  std::unique_ptr<Publication> Advertise(const TopicSettings&) override {
    return std::make_unique<NoPublication>();
  }
  void Log(Severity, const std::string& line) override { lines.push_back(line); }

  std::map<std::string, Receive> receivers;
  std::vector<std::function<void()>> later;
  std::set<std::string> published;
  std::vector<std::string> lines;
};

TEST(Node, TellsWhatItWaitsForAndWhatIsMissing) {
  SilentTransport transport;
  transport.published = {"/right/image/compressed"};
  const Parameters parameters = {{"sensor", std::string("stereo")},
                                 {"camera", std::string("euroc")},
                                 {"image_transport", std::string("compressed")}};
  const auto node = MakeNode(transport, parameters, {});
  EXPECT_THAT(
      transport.lines,
      testing::ElementsAre("waits for frames of /left/image/compressed, /right/image/compressed"));
  ASSERT_EQ(transport.later.size(), 1U);
  transport.later[0]();
  EXPECT_EQ(transport.lines.back(),
            "no frame in 5 s: /left/image/compressed has no publisher, /right/image/compressed has "
            "no message that can be used");
  std::int64_t stamp_ns = 1'000'000'000;
  for (const char* topic : {"/left/image/compressed", "/right/image/compressed"}) {
    const std::string message =
        CompressedImageMessage(Dialect::kCdr, {stamp_ns, "png", 0, 0, 0, "pixels"});
    transport.receivers[topic](Bytes(message.begin(), message.end()));
    stamp_ns += 1'000'000'000;
  }
  transport.later[0]();
  EXPECT_EQ(transport.lines.back(),
            "no frame in 5 s: no two images have fitting stamps (parameter sync)");
}

TEST(Node, WaitsForTheCameraWithoutAFile) {
  SilentTransport transport;
  const auto node = MakeNode(transport, {}, {});
  EXPECT_THAT(transport.lines, testing::ElementsAre("waits for frames of /camera_info, /image"));
}

TEST(Node, NamesOptionsAsTheUserDoes) {
  SilentTransport transport;
  const Parameters parameters = {{"options.features.line_count", std::string("many")}};
  EXPECT_THAT(MessageOf([&] { MakeNode(transport, parameters, {}); }),
              testing::StartsWith("options.features.line_count: "));
}

}  // namespace
}  // namespace plumbline::ros_node
