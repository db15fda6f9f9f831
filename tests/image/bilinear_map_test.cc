// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/bilinear_map.h"

#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

GrayImage Noise(Rng& rng, int width, int height) {
  GrayImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<std::uint8_t>(rng.Index(256));
  }
  return image;
}

// By maps in fixed point, as ours.
cv::Mat Remapped(const GrayImage& from, const Image<float>& x, const Image<float>& y) {
  cv::Mat px, fraction, result;
  cv::convertMaps(AsMat(x), AsMat(y), px, fraction, CV_16SC2, false);
  cv::remap(AsMat(from), result, px, fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

TEST(BilinearMap, IsTheRemapOfOpenCvToTheLastBit) {
  Rng rng(1, "bilinear_map");
  const GrayImage from = Noise(rng, 97, 61);
  Image<float> x(141, 83), y(141, 83);
  for (int v = 0; v < 83; ++v) {
    for (int u = 0; u < 141; ++u) {
      // Inside, at whole pixels, half way between 1/32 of them, along and beyond the border.
      const auto kind = rng.Index(5);
      x.at(u, v) = static_cast<float>(rng.Uniform(-8, 105));
      y.at(u, v) = static_cast<float>(rng.Uniform(-8, 69));
      if (kind == 0) x.at(u, v) = std::floor(x.at(u, v));
      if (kind == 1) y.at(u, v) = std::floor(64 * y.at(u, v)) / 64;
      if (kind == 2 && rng.Index(10) == 0) x.at(u, v) = y.at(u, v) = -10000;
    }
  }
  const GrayImage ours = BilinearMap(x, y, 97, 61).Apply(from);
  EXPECT_EQ(cv::norm(AsMat(ours), Remapped(from, x, y), cv::NORM_INF), 0);
}

TEST(BilinearMap, KnowsImagesOfASingleRowOrColumn) {
  Rng rng(3, "bilinear_map");
  Image<float> x(40, 30), y(40, 30);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      x.at(u, v) = static_cast<float>(rng.Uniform(-3, 12));
      y.at(u, v) = static_cast<float>(rng.Uniform(-3, 12));
    }
  }
  for (const auto& [width, height] : {std::pair{1, 9}, {9, 1}, {1, 1}}) {
    const GrayImage from = Noise(rng, width, height);
    const GrayImage ours = BilinearMap(x, y, width, height).Apply(from);
    EXPECT_EQ(cv::norm(AsMat(ours), Remapped(from, x, y), cv::NORM_INF), 0);
  }
}

TEST(BilinearMap, ReachesTheEndOfAWideImage) {
  GrayImage from(40'000, 2, 10);
  from.at(39'000, 0) = from.at(39'000, 1) = 200;
  Image<float> x(1, 1), y(1, 1);
  x.at(0, 0) = 39'000;
  EXPECT_EQ(BilinearMap(x, y, from.width(), from.height()).Apply(from).at(0, 0), 200);
}

TEST(BilinearMap, TakesPixelsAsTheyAreFromWholePlaces) {
  Rng rng(2, "bilinear_map");
  const GrayImage from = Noise(rng, 20, 10);
  Image<float> x(20, 10), y(20, 10);
  for (int v = 0; v < 10; ++v) {
    for (int u = 0; u < 20; ++u) {
      x.at(u, v) = static_cast<float>(19 - u);
      y.at(u, v) = static_cast<float>(v);
    }
  }
  const GrayImage mirrored = BilinearMap(x, y, 20, 10).Apply(from);
  for (int v = 0; v < 10; ++v) {
    for (int u = 0; u < 20; ++u) EXPECT_EQ(mirrored.at(u, v), from.at(19 - u, v));
  }
  EXPECT_THROW(BilinearMap(x, y, 20, 10).Apply(GrayImage(19, 10)), BugError);
}

}  // namespace
}  // namespace plumbline
