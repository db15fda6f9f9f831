// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/gaussian_blur.h"

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

}  // namespace
}  // namespace plumbline
