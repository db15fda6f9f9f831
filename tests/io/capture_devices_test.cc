// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/capture_devices.h"

#include "plumbline/image/opencv_modules.h"

#include "tests/io/scratch_folder.h"
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(CameraDevices, AreOneOrTwo) {
  EXPECT_THAT(CameraDevices("camera:0"), ElementsAre("0"));
  EXPECT_THAT(CameraDevices("camera:2,0"), ElementsAre("2", "0"));
  EXPECT_THAT(CameraDevices("camera:/dev/video2"), ElementsAre("/dev/video2"));
  for (const char* name :
       {"camera:", "camera:x", "camera:-1", "camera:0,", "camera:0,1,2", "camera:1000"}) {
    EXPECT_THAT(MessageOf([&] { CameraDevices(name); }), HasSubstr("expected camera:N")) << name;
  }
}

TEST(GstreamerPipeline, GetsASink) {
  EXPECT_EQ(GstreamerPipeline("gst:a ! b"), "a ! b ! videoconvert ! appsink");
  EXPECT_EQ(GstreamerPipeline("gst:a ! appsink drop=true"), "a ! appsink drop=true");
}

// A device as OpenCV shows it: it opens with images of 640x480, and takes another size once it
// knows both sides.
class FakeCapture : public VideoCapture {
 public:
  bool Open(const std::string&, int, const std::vector<int>&) override { return true; }
  bool Open(int, int) override { return true; }
  bool Grab() override { return true; }
  bool Retrieve(cv::Mat& image) override {
    image = cv::Mat::zeros(size_.height, size_.width, CV_8UC1);
    return true;
  }
  double Get(int) const override { return 0; }
  void Set(int property, double value) override {
    if (property == cv::CAP_PROP_FRAME_WIDTH) asked_.width = static_cast<int>(value);
    if (property == cv::CAP_PROP_FRAME_HEIGHT) asked_.height = static_cast<int>(value);
    if (asked_.width > 0 && asked_.height > 0) size_ = asked_;
  }

 private:
  ImageSize size_{640, 480}, asked_;
};

CaptureDevices Fakes(const std::string& name, LiveKind kind, const std::vector<ImageSize>& sizes) {
  return {name, kind, sizes, [] { return std::make_unique<FakeCapture>(); }};
}

// "752x480", one for each device.
std::vector<std::string> SizesOf(CaptureDevices& devices) {
  std::vector<std::string> sizes;
  const auto taken = devices.Take();
  if (!taken) return sizes;
  for (const cv::Mat& image : taken->images) {
    sizes.push_back(std::to_string(image.cols) + "x" + std::to_string(image.rows));
  }
  return sizes;
}

TEST(CaptureDevices, AskCamerasForTheirSizesWheneverTheyAreOpened) {
  CaptureDevices devices =
      Fakes("camera:0,/dev/video2", LiveKind::kCamera, {{1280, 720}, {800, 600}});
  EXPECT_THAT(SizesOf(devices), ElementsAre("1280x720", "800x600"));
  ASSERT_TRUE(devices.Open());  // after a loss
  EXPECT_THAT(SizesOf(devices), ElementsAre("1280x720", "800x600"));
}

TEST(CaptureDevices, TakeWhatHasNoSizeAsItIs) {
  CaptureDevices second = Fakes("camera:0,1", LiveKind::kCamera, {{1280, 720}});
  EXPECT_THAT(SizesOf(second), ElementsAre("1280x720", "640x480"));
  CaptureDevices stream = Fakes("rtsp://host/a", LiveKind::kNetwork, {{1280, 720}});
  EXPECT_THAT(SizesOf(stream), ElementsAre("640x480"));
  CaptureDevices pipeline = Fakes("gst:a", LiveKind::kGstreamer, {{1280, 720}});
  EXPECT_THAT(SizesOf(pipeline), ElementsAre("640x480"));
}

TEST(DeviceSizes, AreThoseOfTheCalibration) {
  Calibration calibration;
  calibration.left = Camera({.fx = 500, .fy = 500, .width = 752, .height = 480});
  EXPECT_THAT(DeviceSizes(calibration, false), ElementsAre(ImageSize{752, 480}));
  EXPECT_THAT(DeviceSizes(calibration, true), ElementsAre(ImageSize{1504, 480}));
  calibration.right = Camera({.fx = 500, .fy = 500, .width = 640, .height = 400});
  EXPECT_THAT(DeviceSizes(calibration, false),
              ElementsAre(ImageSize{752, 480}, ImageSize{640, 400}));
  EXPECT_THAT(DeviceSizes(calibration, true), ElementsAre(ImageSize{1504, 480}));
}

}  // namespace
}  // namespace plumbline
