// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/filters.h"

#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace plumbline {

namespace {

TEST(GaussianBlur, IsThatOfOpenCvToTheLastBit) {
  Rng rng(1, "gaussian_blur");
  for (const auto& [width, height] :
       {std::pair{101, 37}, {64, 9}, {40, 7}, {9, 40}, {4, 5}, {33, 4}}) {
    GrayImage image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        // Many pixels at the ends of the range, where a sum is largest.
        image.at(x, y) = static_cast<std::uint8_t>(rng.Index(3) == 0 ? 255 : rng.Index(256));
      }
    }
    for (const auto& [border, of_opencv] : {std::pair{ImageBorder::kRepeated, cv::BORDER_REPLICATE},
                                            {ImageBorder::kReflected, cv::BORDER_REFLECT_101}}) {
      for (const auto& [weights, sigma] : {std::pair{kBlurSigma1, 1.0}, {kBlurSigma2, 2.0}}) {
        cv::Mat expected;
        cv::GaussianBlur(AsMat(image), expected, {7, 7}, sigma, sigma, of_opencv);
        const GrayImage blurred = Blurred(image, weights, border);
        EXPECT_EQ(cv::norm(AsMat(blurred), expected, cv::NORM_INF), 0)
            << width << "x" << height << ", " << sigma << ", " << of_opencv;
      }
    }
  }
}

TEST(GaussianBlur, AnImageOfOneColourStaysAsItIs) {
  for (const int level : {0, 1, 254, 255}) {
    const GrayImage image(50, 3, static_cast<std::uint8_t>(level));
    const GrayImage blurred = Blurred(image, kBlurSigma2, ImageBorder::kReflected);
    EXPECT_EQ(cv::norm(AsMat(blurred), AsMat(image), cv::NORM_INF), 0);
  }
  EXPECT_TRUE(Blurred(GrayImage(), kBlurSigma1, ImageBorder::kRepeated).empty());
}

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

TEST(BoxFilter, SpreadsASpotEvenlyOverItsWindow) {
  GrayImage image(9, 7);
  image.at(4, 3) = 250;
  const GrayImage filtered = BoxFiltered(image, 5);
  ASSERT_EQ(filtered.width(), 9);
  ASSERT_EQ(filtered.height(), 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      const bool inside = x >= 2 && x <= 6 && y >= 1 && y <= 5;
      EXPECT_EQ(filtered.at(x, y), inside ? 10 : 0) << x << ", " << y;
    }
  }
}

TEST(BoxFilter, RepeatsTheBorder) {
  GrayImage image(4, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) image.at(x, y) = 77;
  }
  EXPECT_EQ(BoxFiltered(image, 3).at(0, 0), 77);
  EXPECT_EQ(BoxFiltered(image, 3).at(3, 3), 77);
}

TEST(BoxFilter, SizeOneChangesNothing) {
  GrayImage image(3, 2);
  image.at(2, 1) = 9;
  const GrayImage filtered = BoxFiltered(image, 1);
  EXPECT_EQ(filtered.at(2, 1), 9);
  EXPECT_EQ(filtered.at(1, 1), 0);
}

}  // namespace

}  // namespace plumbline
