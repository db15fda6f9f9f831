// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gradient.h"

#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

GrayImage Ramp() {
  GrayImage image(40, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) image.at(x, y) = static_cast<std::uint8_t>(3 * x + 2 * y);
  }
  return image;
}

TEST(Gradient, IsTheSlopeOfARampInGreyLevelsPerPixel) {
  for (const double sigma : {0.0, 1.0}) {
    const GradientImage gradient = ComputeGradient(Ramp(), sigma);
    EXPECT_NEAR(gradient.dx.at(17, 12) / kSobelGain, 3, 0.1);
    EXPECT_NEAR(gradient.dy.at(17, 12) / kSobelGain, 2, 0.1);
  }
}

TEST(Gradient, IsThatOfOpenCvToTheLastBit) {
  for (const auto& [width, height] : {std::pair{101, 37}, {64, 1}, {1, 9}, {33, 2}}) {
    Rng rng(1, "gradient");
    GrayImage image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<std::uint8_t>(rng.Index(256));
    }
    const GradientImage gradient = ComputeGradient(image, 0);
    cv::Mat dx, dy;
    cv::Sobel(AsMat(image), dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
    cv::Sobel(AsMat(image), dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
    EXPECT_EQ(cv::norm(AsMat(gradient.dx), dx, cv::NORM_INF), 0) << width << "x" << height;
    EXPECT_EQ(cv::norm(AsMat(gradient.dy), dy, cv::NORM_INF), 0) << width << "x" << height;
  }
}

}  // namespace
}  // namespace plumbline
