// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/raw_pixels.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(RawPixels, KnowsWhatEncodingsShow) {
  for (const char* name : {"mono8", "rgb8", "bgr8", "rgba8", "bgra8", "8UC1", "8UC3", "8UC4"}) {
    EXPECT_EQ(ContentsOfEncoding(name), ImageContents::kGray) << name;
  }
  for (const char* name : {"mono16", "16UC1", "32FC1"}) {
    EXPECT_EQ(ContentsOfEncoding(name), ImageContents::kDepth) << name;
  }
  EXPECT_EQ(ContentsOfEncoding("bayer_rggb16"), std::nullopt);
  EXPECT_EQ(EncodingsOf(ImageContents::kGray),
            "mono8, 8UC1, rgb8, bgr8, 8UC3, rgba8, bgra8, 8UC4, bayer_rggb8, bayer_bggr8, "
            "bayer_gbrg8, bayer_grbg8, yuv422, uyvy, yuv422_yuy2, yuyv, nv12 or nv21");
  EXPECT_EQ(EncodingsOf(ImageContents::kDepth), "mono16, 16UC1 or 32FC1");
  EXPECT_EQ(PixelBytes("rgb8"), 3);
  EXPECT_EQ(PixelBytes("32FC1"), 4);
}

TEST(RawPixels, ReadsDepthOfEitherByteOrder) {
  const std::array<std::uint8_t, 4> bytes = {0x03, 0xE8, 0x00, 0x00};
  const RawPixels pixels{"16UC1", 2, 1, 4, true, bytes};
  const auto depth = DepthOfPixels("x", pixels, 1000, std::nullopt);
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->at(0, 0), 1.0F);
  EXPECT_EQ(depth->at(1, 0), 0.0F);
  const std::array<std::uint8_t, 4> float_bytes = {0x3F, 0xC0, 0, 0};
  const RawPixels metres{"32FC1", 1, 1, 4, true, float_bytes};
  EXPECT_EQ(DepthOfPixels("x", metres, 1000, std::nullopt)->at(0, 0), 1.5F);
  const std::array<std::uint8_t, 4> negative_bytes = {0xBF, 0xC0, 0, 0};
  const RawPixels negative{"32FC1", 1, 1, 4, true, negative_bytes};
  EXPECT_EQ(DepthOfPixels("x", negative, 1000, std::nullopt)->at(0, 0), 0.0F);
}

// A grey ramp from left to right, as each encoding has it.
TEST(RawPixels, DecodesWhatCamerasSend) {
  constexpr std::uint32_t kWidth = 16, kHeight = 12;
  for (const char* name : {"bayer_rggb8",
                           "bayer_bggr8",
                           "bayer_gbrg8",
                           "bayer_grbg8",
                           "yuv422",
                           "uyvy",
                           "yuv422_yuy2",
                           "yuyv",
                           "nv12",
                           "nv21"}) {
    const auto bytes = static_cast<std::uint32_t>(PixelBytes(name));
    const bool grey_first = std::string_view(name).find("yuy") != std::string_view::npos;
    std::vector<std::uint8_t> data;
    for (int y = 0; y < PixelRows(name, kHeight); ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const auto level = static_cast<std::uint8_t>(y < int{kHeight} ? 10 * x : 128);
        data.push_back(bytes == 1 || grey_first ? level : 128);
        if (bytes == 2) data.push_back(grey_first ? 128 : level);
      }
    }
    RawPixels pixels{name, kWidth, kHeight, kWidth * bytes, false, data};
    const auto gray = GrayOfPixels("x", pixels, std::nullopt);
    ASSERT_TRUE(gray) << name;
    for (int x = 2; x < 14; ++x) EXPECT_NEAR(gray->at(x, 6), 10 * x, 5) << name;
    pixels.data = pixels.data.first(data.size() - 1);
    EXPECT_FALSE(GrayOfPixels("x", pixels, std::nullopt)) << name;
  }
}

// Of a red image, each pattern has light where its name has an r.
TEST(RawPixels, KnowsWhichPixelOfAPatternIsRed) {
  const std::map<std::string, std::pair<int, int>> red = {{"bayer_rggb8", {0, 0}},
                                                          {"bayer_grbg8", {1, 0}},
                                                          {"bayer_gbrg8", {0, 1}},
                                                          {"bayer_bggr8", {1, 1}}};
  for (const auto& [name, place] : red) {
    std::vector<std::uint8_t> data(64, 0);
    for (int y = place.second; y < 8; y += 2) {
      for (int x = place.first; x < 8; x += 2) data[static_cast<std::size_t>(8 * y + x)] = 200;
    }
    const auto gray = GrayOfPixels("x", {name, 8, 8, 8, false, data}, std::nullopt);
    ASSERT_TRUE(gray);
    for (int y = 2; y < 6; ++y) {
      for (int x = 2; x < 6; ++x) EXPECT_NEAR(gray->at(x, y), 0.299 * 200, 2) << name;
    }
  }
}

TEST(RawPixels, RefusesSizesThatDoNotGoTogether) {
  const std::array<std::uint8_t, 12> bytes{};
  const auto why = [&](std::uint32_t width, std::uint32_t height, std::uint32_t step) {
    const auto image =
        GrayOfPixels("x", {"mono8", width, height, step, false, bytes}, std::nullopt);
    return image ? std::string("none") : image.error().why;
  };
  EXPECT_EQ(why(4, 3, 4), "none");
  EXPECT_EQ(why(3, 3, 4), "none");
  EXPECT_EQ(why(4, 3, 3), "expected rows of at least 4 bytes, found 3");
  EXPECT_EQ(why(4, 4, 4), "expected 16 bytes of pixels, found 12");
  EXPECT_EQ(why(0, 3, 4), "an image of 0x3 pixels, expected some and at most 100 million");
  EXPECT_EQ(why(0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF),
            "an image of 4294967295x4294967295 pixels, expected some and at most 100 million");
  const auto other = GrayOfPixels("x", {"mono8", 4, 3, 4, false, bytes}, ImageSize{3, 4});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().other_size, (ImageSize{4, 3}));
  EXPECT_FALSE(DepthOfPixels("x", {"mono8", 4, 3, 4, false, bytes}, 1, std::nullopt));
}

}  // namespace
}  // namespace plumbline
