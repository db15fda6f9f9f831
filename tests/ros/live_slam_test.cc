// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros/live_slam.h"

#include "plumbline/base/error.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace plumbline::ros_node {
namespace {

// Numbers of which only P, of the rectified images, can be those of a camera.
CameraNumbers RectifiedNumbers() {
  CameraNumbers camera;
  camera.topic = "/camera/camera_info";
  camera.width = 640;
  camera.height = 480;
  camera.distortion_model = "plumb_bob";
  camera.d = {0, 0, 0, 0, 0};
  camera.k = {-500, 0, 320, 0, -500, 240, 0, 0, 1};
  camera.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  camera.p = {500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0};
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

}  // namespace
}  // namespace plumbline::ros_node
