// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/opencv_modules.h"

#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace plumbline {
namespace {

TEST(LoadOpenCvModules, GivesTheSameToAllThreads) {
  const OpenCvModules* of_another = nullptr;
  std::thread([&] { of_another = &LoadOpenCvModules(); }).join();
  EXPECT_EQ(&LoadOpenCvModules(), of_another);
}

TEST(OpenCvModules, DecodesImagesAndRefusesOthers) {
  const cv::Mat image(5, 7, CV_8UC1, cv::Scalar(99));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".bmp", image, bytes);
  const cv::Mat read = LoadOpenCvModules().DecodeImage(bytes, cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0);
  bytes.resize(3);
  EXPECT_TRUE(LoadOpenCvModules().DecodeImage(bytes, cv::IMREAD_GRAYSCALE).empty());
}

TEST(OpenCvModules, FindsTheSidesOfASquare) {
  cv::Mat image(100, 100, CV_8UC1, cv::Scalar(40));
  cv::rectangle(image, {20, 20}, {80, 80}, cv::Scalar(200), cv::FILLED);
  cv::GaussianBlur(image, image, {5, 5}, 1);
  EXPECT_EQ(LoadOpenCvModules().EdgeDrawingLines(image).size(), 4U);
}

TEST(OpenCvModules, OpensNoVideoWhereThereIsNone) {
#if defined(__SANITIZE_ADDRESS__)
  // GStreamer's plugins leave what they found on their search for devices.
  const __lsan::ScopedDisabler left_by_plugins;
#endif
  const auto capture = LoadOpenCvModules().NewVideoCapture();
  EXPECT_FALSE(capture->Open("/nowhere.mp4", 0));
  cv::Mat image;
  EXPECT_FALSE(capture->Grab());
  EXPECT_FALSE(capture->Retrieve(image));
}

}  // namespace
}  // namespace plumbline
