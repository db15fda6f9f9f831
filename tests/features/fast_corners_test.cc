// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/fast_corners.h"

#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include "tests/features/render.h"
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

namespace plumbline {
namespace {

using Entry = std::tuple<int, int, float>;

// Corners of cv::FAST in a box: it looks at no pixel nearer than 3 to the border of what it gets.
std::vector<Entry> CornersOfOpenCv(const GrayImage& image, const PixelBox& box, int threshold) {
  const cv::Rect window(box.x0 - 3, box.y0 - 3, box.x1 - box.x0 + 6, box.y1 - box.y0 + 6);
  std::vector<cv::KeyPoint> found;
  cv::FAST(AsMat(image)(window), found, threshold, true);
  std::vector<Entry> corners;
  for (const cv::KeyPoint& k : found) {
    corners.emplace_back(
        static_cast<int>(k.pt.x) + window.x, static_cast<int>(k.pt.y) + window.y, k.response);
  }
  return corners;
}

std::vector<Entry> Ours(const FastCorners& fast, const PixelBox& box, int threshold) {
  std::vector<FastCorner> found;
  fast.Collect(box, threshold, &found);
  std::vector<Entry> corners;
  for (const FastCorner& c : found) corners.emplace_back(c.x, c.y, c.response);
  return corners;
}

GrayImage Noise(int width, int height) {
  Rng rng(1, "fast_corners");
  GrayImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<std::uint8_t>(rng.Index(256));
  }
  return image;
}

void ExpectThoseOfOpenCv(const GrayImage& image) {
  const PixelBox area{3, 3, image.width() - 3, image.height() - 3};
  const FastCorners fast(image, area);
  std::size_t all = 0;
  for (const int threshold : {1, 4, 20, 100, 255}) {
    const std::vector<Entry> expected = CornersOfOpenCv(image, area, threshold);
    EXPECT_EQ(Ours(fast, area, threshold), expected) << threshold;
    all += expected.size();
    for (const PixelBox& part : {PixelBox{3, 3, 38, 38}, PixelBox{40, 17, 75, 52}}) {
      EXPECT_EQ(Ours(fast, part, threshold), CornersOfOpenCv(image, part, threshold)) << threshold;
    }
  }
  EXPECT_GT(all, 100U);
}

TEST(FastCorners, AreThoseOfOpenCv) {
  ExpectThoseOfOpenCv(Render(173, 121, SquareTexture(60, 173, 121)));
}

TEST(FastCorners, AreThoseOfOpenCvInNoise) { ExpectThoseOfOpenCv(Noise(131, 97)); }

TEST(FastCorners, APartMayReachOverTheArea) {
  const GrayImage image = Noise(90, 80);
  const FastCorners fast(image, {20, 20, 70, 60});
  EXPECT_EQ(Ours(fast, {50, 40, 300, 300}, 4), CornersOfOpenCv(image, {50, 40, 70, 60}, 4));
  EXPECT_TRUE(Ours(fast, {70, 20, 90, 60}, 4).empty());
  EXPECT_TRUE(Ours(FastCorners(image, {40, 40, 40, 60}), {40, 40, 40, 60}, 4).empty());
}

}  // namespace
}  // namespace plumbline
