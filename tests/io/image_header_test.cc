// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace plumbline {
namespace image_header_test {

using Bytes = std::vector<std::uint8_t>;

Bytes Encoded(const std::string& extension, int width, int height, std::vector<int> how = {}) {
  Bytes bytes;
  const cv::Mat image(height, width, extension == ".pbm" ? CV_8UC1 : CV_8UC3, cv::Scalar::all(77));
  cv::Mat gray(height, width, CV_8UC1, cv::Scalar(77));
  EXPECT_TRUE(cv::imencode(extension, extension == ".pgm" ? gray : image, bytes, how)) << extension;
  return bytes;
}

Bytes Text(const std::string& text) { return {text.begin(), text.end()}; }

TEST(SizeInHeader, IsThatOfTheDecodedImage) {
  const std::vector<ImageSize> sizes = {{1, 1}, {37, 5}, {752, 480}, {300, 700}};
  for (const ImageSize& size : sizes) {
    for (const char* extension : {".png", ".jpg", ".webp", ".pgm", ".ppm", ".bmp", ".tiff"}) {
      EXPECT_EQ(SizeInHeader(Encoded(extension, size.width, size.height)), size) << extension;
    }
    EXPECT_EQ(
        SizeInHeader(Encoded(".webp", size.width, size.height, {cv::IMWRITE_WEBP_QUALITY, 50})),
        size);
    EXPECT_EQ(
        SizeInHeader(Encoded(".jpg", size.width, size.height, {cv::IMWRITE_JPEG_PROGRESSIVE, 1})),
        size);
  }
}

TEST(SizeInHeader, ReadsRarerForms) {
  EXPECT_EQ(SizeInHeader(Text("P5 # made by hand\n# twice\n 8\t6 255\n")), (ImageSize{8, 6}));
  // An extended WebP file; an upside-down BMP; a TIFF file of the other byte order.
  EXPECT_EQ(
      SizeInHeader(Text(std::string("RIFF\0\0\0\0WEBPVP8X\12\0\0\0\0\0\0\0\7\0\0\5\0\0", 30))),
      (ImageSize{8, 6}));
  Bytes bmp = Encoded(".bmp", 8, 6);
  for (std::size_t i = 0; i < 4; ++i) bmp[22 + i] = i == 0 ? 0xFA : 0xFF;  // -6
  EXPECT_EQ(SizeInHeader(bmp), (ImageSize{8, 6}));
  EXPECT_EQ(SizeInHeader(Text(std::string("MM\0*\0\0\0\10\0\2"
                                          "\1\0\0\3\0\0\0\1\0\10\0\0"
                                          "\1\1\0\4\0\0\0\1\0\0\0\6",
                                          34))),
            (ImageSize{8, 6}));
}

TEST(SizeInHeader, IsNoneWhereThereIsNoHeader) {
  EXPECT_EQ(SizeInHeader({}), std::nullopt);
  EXPECT_EQ(SizeInHeader(Text("not an image at all")), std::nullopt);
  EXPECT_EQ(SizeInHeader(Text("P5\nx 6\n255\n")), std::nullopt);
  EXPECT_EQ(SizeInHeader(Text("P5\n0 6\n255\n")), std::nullopt);
  EXPECT_EQ(SizeInHeader(Text("P5\n99999999999999999999999 6\n255\n")), std::nullopt);
  EXPECT_EQ(SizeInHeader(Text("GIF89a")), std::nullopt);
}

TEST(IsGreyOf16Bits, IsSaidByTheHeader) {
  Bytes deep, color;
  ASSERT_TRUE(cv::imencode(".png", cv::Mat(2, 2, CV_16UC1, cv::Scalar(9)), deep));
  ASSERT_TRUE(cv::imencode(".png", cv::Mat(2, 2, CV_16UC3, cv::Scalar::all(9)), color));
  EXPECT_TRUE(IsGreyOf16Bits(deep));
  EXPECT_FALSE(IsGreyOf16Bits(color));
  EXPECT_FALSE(IsGreyOf16Bits(Encoded(".png", 2, 2)));
  for (const char* header :
       {"P5 8 6 256\n", "P2\n# 12 bits\n8 6\n4095\n", "P5\n8 6 # x\n65535\n"}) {
    EXPECT_TRUE(IsGreyOf16Bits(Text(header))) << header;
  }
  for (const char* header :
       {"P5 8 6 255\n", "P6 8 6 4095\n", "P5 8 6 65536\n", "P5 8 6", "P5", ""}) {
    EXPECT_FALSE(IsGreyOf16Bits(Text(header))) << header;
  }
}

// Whatever is cut off, nothing is read beyond the end, and no other size is made up.
TEST(SizeInHeader, TakesHeadersThatEndEarly) {
  for (const char* extension : {".png", ".jpg", ".webp", ".bmp", ".tiff"}) {
    Bytes bytes = Encoded(extension, 300, 200);
    const std::size_t longest = std::min<std::size_t>(bytes.size(), 2000);
    for (std::size_t size = 0; size < longest; ++size) {
      (void)SizeInHeader(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    }
  }
}

// EXIF data that ask for an orientation, with the highest byte of a number first or last.
std::string Exif(int orientation, bool big) {
  const std::string number(1, static_cast<char>(orientation));
  if (big) {
    return std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) + number +
           std::string(6, '\0');
  }
  return std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) + number +
         std::string(7, '\0');
}

int OrientationIn(const std::string& file) { return ExifOrientation(Text(file)); }

TEST(ExifOrientation, IsFoundInFilesOfEachType) {
  const std::string jpeg_start = "\xFF\xD8\xFF";
  for (const bool big : {false, true}) {
    for (const int number : {1, 3, 6, 8}) {
      const std::string exif = Exif(number, big);
      const auto length = static_cast<char>(exif.size());
      const std::string segment = std::string("\xE1\0", 2) + static_cast<char>(length + 8) +
                                  std::string("Exif\0\0", 6) + exif;
      const std::string comment("\xFE\0\4ab\xFF", 6);
      EXPECT_EQ(OrientationIn(jpeg_start + segment), number);
      EXPECT_EQ(OrientationIn(jpeg_start + comment + segment), number);
      const std::string png = std::string("\x89PNG\r\n\x1a\n\0\0\0\1tEXtaCRCC\0\0\0", 24) + length;
      EXPECT_EQ(OrientationIn(png + "eXIf" + exif + "CRCC"), number);
      const std::string webp("RIFF\0\0\0\0WEBPVP8X\4\0\0\0abc\0EXIF", 28);
      const std::string size = length + std::string(3, '\0');
      EXPECT_EQ(OrientationIn(webp + size + exif), number);
      EXPECT_EQ(OrientationIn(webp + size + std::string("Exif\0\0", 6) + exif), number);
      EXPECT_EQ(OrientationIn(exif), number);  // a TIFF file
    }
    for (const int number : {0, 9, 255}) EXPECT_EQ(OrientationIn(Exif(number, big)), 1);
  }
  const std::string segment(
      "\xE1\0\x22"
      "Exif\0\0",
      9);
  const std::string whole = jpeg_start + segment + Exif(6, false);
  for (std::size_t end = 0; end + 8 < whole.size(); ++end) {
    EXPECT_EQ(OrientationIn(whole.substr(0, end)), 1) << end;
  }
}

}  // namespace image_header_test
}  // namespace plumbline
