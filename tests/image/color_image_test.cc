// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/color_image.h"

#include "plumbline/base/error.h"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Two rows of two pixels with a byte behind each row.
constexpr std::array<std::uint8_t, 14> kBytes = {1, 2, 3, 4, 5, 6, 99, 7, 8, 9, 10, 11, 12, 99};

TEST(ColorImage, IsReadFromPixelsSideBySide) {
  const ColorImage bgr = FromInterleaved(2, 2, {kBytes, 7});
  EXPECT_TRUE((bgr.at(1, 0) == Color{6, 5, 4}));
  EXPECT_TRUE((bgr.at(0, 1) == Color{9, 8, 7}));
  const ColorImage rgb = FromInterleaved(2, 2, {kBytes, 7, 3, 0});
  EXPECT_TRUE((rgb.at(1, 1) == Color{10, 11, 12}));
  const ColorImage with_alpha = FromInterleaved(1, 2, {kBytes, 7, 4, 0});
  EXPECT_TRUE((with_alpha.at(0, 1) == Color{7, 8, 9}));
  EXPECT_THROW(FromInterleaved(2, 3, {kBytes, 7}), BugError);
}

// 0.299 R + 0.587 G + 0.114 B
TEST(ColorImage, HasAGreyImage) {
  const ColorImage image{GrayImage(3, 2, 0xA0), GrayImage(3, 2, 0x50), GrayImage(3, 2, 0x10)};
  EXPECT_EQ(ToGray(image).at(2, 1), 97);
  EXPECT_FALSE(IsGray(image));
  ColorImage gray = ToColor(GrayImage(3, 2, 77));
  EXPECT_TRUE(IsGray(gray));
  EXPECT_EQ(ToGray(gray).at(1, 1), 77);
  gray.blue.at(2, 1) = 78;
  EXPECT_FALSE(IsGray(gray));
}

TEST(ColorImage, IsChangedChannelByChannel) {
  const ColorImage image{GrayImage(3, 2, 1), GrayImage(3, 2, 2), GrayImage(3, 2, 3)};
  const ColorImage turned = WithEachChannel(
      image, [](const GrayImage& channel) { return GrayImage(2, 3, channel.at(0, 0)); });
  EXPECT_EQ(turned.width(), 2);
  EXPECT_EQ(turned.height(), 3);
  EXPECT_TRUE((turned.at(1, 2) == Color{1, 2, 3}));
}

}  // namespace
}  // namespace plumbline
