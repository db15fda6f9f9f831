// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/png.h"

#include "plumbline/io/datasets/image_file.h"

#include "tests/io/scratch_folder.h"
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace plumbline {
namespace {

TEST(WriteGrayPng, KeepsThePixels) {
  const ScratchFolder folder;
  GrayImage image(5, 3, 10);
  image.at(4, 2) = 255;
  image.at(0, 1) = 0;
  WriteGrayPng(folder / "a.png", image);
  const auto read = ReadGrayImage(folder / "a.png");
  ASSERT_TRUE(read);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) EXPECT_EQ(read->at(x, y), image.at(x, y));
  }
}

TEST(WriteColorPng, KeepsThePixels) {
  const ScratchFolder folder;
  const ColorImage image{GrayImage(20, 10, 1), GrayImage(20, 10, 2), GrayImage(20, 10, 3)};
  WriteColorPng(folder / "color.png", image);
  const auto read = ReadColorImage(folder / "color.png");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->width(), 20);
  EXPECT_TRUE((read->at(19, 9) == Color{1, 2, 3}));
  WriteColorPng(folder / "gray.png", ToColor(image.red));
  WriteGrayPng(folder / "one channel.png", image.red);
  EXPECT_EQ(Contents(folder / "gray.png"), Contents(folder / "one channel.png"));
}

TEST(WriteOverlayPng, DrawsInTheColoursGiven) {
  const ScratchFolder folder;
  const GrayImage image(40, 30, 100);
  const double inf = std::numeric_limits<double>::infinity();
  Overlay overlay;
  overlay.segments.push_back({{{5, 10}, {30, 10}}, {255, 0, 0}});
  overlay.segments.push_back({{{5, 10}, {inf, 10}}, {255, 0, 0}});  // not drawn
  overlay.points.push_back({{20, 20}, {0, 0, 255}});
  WriteOverlayPng(folder / "a.png", image, overlay);
  const cv::Mat read = cv::imread((folder / "a.png").string(), cv::IMREAD_COLOR);
  ASSERT_EQ(read.cols, 40);
  EXPECT_GT(read.at<cv::Vec3b>(10, 15)[2], 230);  // BGR
  EXPECT_LT(read.at<cv::Vec3b>(10, 15)[0], 25);
  EXPECT_EQ(read.at<cv::Vec3b>(20, 20), cv::Vec3b(100, 100, 100));
  EXPECT_GT(read.at<cv::Vec3b>(20, 22)[0], 150);  // ring of radius 2
  EXPECT_EQ(read.at<cv::Vec3b>(2, 2), cv::Vec3b(100, 100, 100));
}

TEST(EncodeOverlayPng, GivesTheSameBytesAgain) {
  const GrayImage image(40, 30, 100);
  const Overlay overlay{{{{3, 4}}}, {{{{1, 2}, {30, 20}}}}};
  EXPECT_EQ(EncodeOverlayPng(image, overlay), EncodeOverlayPng(image, overlay));
}

}  // namespace
}  // namespace plumbline
