// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/live_slam.h"

#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kWidth = 64, kHeight = 48;

// Numbers of which only P, of the rectified images, can be those of a camera.
TopicCamera RectifiedNumbers() {
  TopicCamera camera;
  camera.topic = "/camera/camera_info";
  camera.message.width = 640;
  camera.message.height = 480;
  camera.message.distortion_model = "plumb_bob";
  camera.message.d = {0, 0, 0, 0, 0};
  camera.message.k = {-500, 0, 320, 0, -500, 240, 0, 0, 1};
  camera.message.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  camera.message.p = {500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0};
  return camera;
}

// Whether images of a topic are taken to be rectified.
bool AreRectified(std::optional<bool> rectified, const std::string& topic) {
  LiveSlamSettings settings;
  settings.rectified = rectified;
  LiveSlam slam(settings, [](const FrameOutcome&) {});
  try {
    slam.SetCameras(RectifiedNumbers(), std::nullopt, topic);
  } catch (const InputError&) {
    EXPECT_FALSE(slam.IsCalibrated());
    return false;
  }
  return slam.IsCalibrated();
}

TEST(LiveSlam, TellsRectifiedImagesByTheirTopicUnlessItIsTold) {
  for (const char* topic : {"/camera/image_rect", "/camera/image_rect_color"}) {
    EXPECT_TRUE(AreRectified(std::nullopt, topic)) << topic;
    EXPECT_FALSE(AreRectified(false, topic)) << topic;
  }
  for (const char* topic : {"/camera/image_raw", "/rectified/image"}) {
    EXPECT_FALSE(AreRectified(std::nullopt, topic)) << topic;
    EXPECT_TRUE(AreRectified(true, topic)) << topic;
  }
}

TopicCamera Numbers() {
  TopicCamera numbers;
  numbers.topic = "/camera_info";
  numbers.message.width = kWidth;
  numbers.message.height = kHeight;
  numbers.message.distortion_model = "plumb_bob";
  numbers.message.d = {0, 0, 0, 0, 0};
  numbers.message.k = {50, 0, 32, 0, 50, 24, 0, 0, 1};
  numbers.message.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  numbers.message.p = {50, 0, 32, 0, 0, 50, 24, 0, 0, 0, 1, 0};
  return numbers;
}

// A file with an empty map of another camera.
std::filesystem::path MapOfAnotherCamera(const ScratchFolder& folder) {
  Atlas atlas;
  atlas.Start();
  AtlasContext context;
  context.camera = {70, 70, 32, 24, 0, kWidth, kHeight};
  SaveAtlas(folder / "other.plb", atlas, context);
  return folder / "other.plb";
}

// Frames of one grey.
class Frames {
 public:
  explicit Frames(LiveSlam& slam) : slam_(slam) {}

  void FeedNext(const std::string& encoding) {
    TopicImage image;
    image.topic = "/image";
    image.message.stamp_ns = stamp_ns_ += 50'000'000;
    image.message.encoding = encoding;
    image.message.width = image.message.step = kWidth;
    image.message.height = kHeight;
    image.message.data = pixels_;
    slam_.Feed(image, nullptr);
  }

 private:
  LiveSlam& slam_;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(std::size_t{kWidth} * kHeight, 90);
  std::int64_t stamp_ns_ = 0;
};

// A map that waits for the camera and does not fit it is tried once. Frames after that are refused
// before anything is done for them, which the pixels of an unknown kind show.
TEST(LiveSlam, TriesAMapThatDoesNotFitOnce) {
  const ScratchFolder folder;
  LiveSlam slam(LiveSlamSettings(), [](const FrameOutcome&) {});
  Frames frames(slam);
  EXPECT_TRUE(slam.Load(MapOfAnotherCamera(folder).string(), false).empty());
  slam.SetCameras(Numbers(), std::nullopt, "/image");
  const std::string message = MessageOf([&] { frames.FeedNext("mono8"); });
  EXPECT_THAT(message, HasSubstr("expected a map of the same rectified camera, found "));
  EXPECT_EQ(MessageOf([&] { frames.FeedNext("mono8"); }), message);
  EXPECT_EQ(MessageOf([&] { frames.FeedNext("unknown"); }), message);
  EXPECT_FALSE(slam.HasFrames());
  slam.Reset();
  EXPECT_EQ(MessageOf([&] { frames.FeedNext("mono8"); }), "no error");
  EXPECT_TRUE(slam.HasFrames());
  EXPECT_THAT(MessageOf([&] { frames.FeedNext("unknown"); }), HasSubstr("the encoding 'unknown'"));
}

}  // namespace
}  // namespace plumbline::ros_node
