// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sys/stat.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

cv::Mat Pattern() {
  cv::Mat image(48, 64, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>((x * 7 + y * y * 3) % 256);
    }
  }
  return image;
}

std::string Encoded(const cv::Mat& image, const std::string& extension) {
  std::vector<std::uint8_t> bytes;
  std::vector<int> parameters;
  if (extension == ".webp") parameters = {cv::IMWRITE_WEBP_QUALITY, 101};  // lossless
  cv::imencode(extension, image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

TEST(ReadGrayImage, ReadsLosslessTypesAlike) {
  const ScratchFolder folder;
  const cv::Mat image = Pattern();
  for (const std::string extension : {".png", ".webp", ".pgm", ".bmp", ".tiff"}) {
    const auto read = ReadGrayImage(folder.Write("a" + extension, Encoded(image, extension)));
    ASSERT_TRUE(read) << extension << ": " << read.error().why;
    ASSERT_EQ(read->width(), 64);
    ASSERT_EQ(read->height(), 48);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) ASSERT_EQ(read->at(x, y), image.at<std::uint8_t>(y, x));
    }
  }
}

// Only zero is black, at any depth and in any channel.
TEST(ReadMask, UsesWhatIsNotZero) {
  const ScratchFolder folder;
  const auto mask_of = [&](const cv::Mat& image, const std::string& extension) {
    const auto mask = ReadMask(folder.Write("m" + extension, Encoded(image, extension)));
    return mask ? std::vector<int>(mask->data(), mask->data() + mask->width()) : std::vector<int>();
  };
  const std::vector<int> wanted = {0, 255, 255};
  EXPECT_EQ(mask_of((cv::Mat_<std::uint8_t>(1, 3) << 0, 1, 255), ".png"), wanted);
  const cv::Mat deep = (cv::Mat_<std::uint16_t>(1, 3) << 0, 1, 65535);
  EXPECT_EQ(mask_of(deep, ".png"), wanted);
  EXPECT_EQ(mask_of(deep, ".pgm"), wanted);
  const cv::Mat color =
      (cv::Mat_<cv::Vec3b>(1, 3) << cv::Vec3b(0, 0, 0), cv::Vec3b(1, 0, 0), cv::Vec3b(0, 0, 1));
  EXPECT_EQ(mask_of(color, ".png"), wanted);
  EXPECT_EQ(mask_of(color, ".bmp"), wanted);
  const cv::Mat deep_color =
      (cv::Mat_<cv::Vec3w>(1, 3) << cv::Vec3w(0, 0, 0), cv::Vec3w(1, 0, 0), cv::Vec3w(0, 0, 1));
  EXPECT_EQ(mask_of(deep_color, ".png"), wanted);
  EXPECT_TRUE(ReadMask(folder / "m.png", ImageSize{4, 1}).error().other_size);
}

TEST(ReadGrayImage, DecodesTheWantedSizeAlone) {
  const ScratchFolder folder;
  const auto file = folder.Write("a.png", Encoded(Pattern(), ".png"));
  EXPECT_TRUE(ReadGrayImage(file, ImageSize{64, 48}));
  const auto other = ReadGrayImage(file, ImageSize{64, 47});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().other_size, (ImageSize{64, 48}));
  EXPECT_EQ(*ReadImageSize(file), (ImageSize{64, 48}));
  const auto bomb = ReadGrayImage(folder.Write("b.pgm", "P5\n30000 30000\n255\n"));
  ASSERT_FALSE(bomb);
  EXPECT_EQ(bomb.error().why, "an image of 30000x30000 pixels, expected at most 100 million");
  EXPECT_FALSE(bomb.error().other_size);
}

// What a decoder of OpenCV takes that we know no header of might be of any size.
TEST(ReadGrayImage, TakesTheKnownKindsAlone) {
  const ScratchFolder folder;
  const auto read = ReadGrayImage(folder.Write("a.png", Encoded(Pattern(), ".sr")));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().why, "not an image this program can decode");
}

TEST(ReadGrayImage, TurnsColourToGreyAlikeForAllTypes) {
  const ScratchFolder folder;
  cv::Mat color(8, 8, CV_8UC3);
  for (int i = 0; i < 64; ++i) {
    color.at<cv::Vec3b>(i / 8, i % 8) = cv::Vec3b(static_cast<std::uint8_t>(i * 4),
                                                  static_cast<std::uint8_t>(255 - i * 3),
                                                  static_cast<std::uint8_t>(i * i % 256));
  }
  const auto png = ReadGrayImage(folder.Write("a.png", Encoded(color, ".png")));
  const auto bmp = ReadGrayImage(folder.Write("a.bmp", Encoded(color, ".bmp")));
  const auto webp = ReadGrayImage(folder.Write("a.webp", Encoded(color, ".webp")));
  for (int i = 0; i < 64; ++i) {
    const cv::Vec3b bgr = color.at<cv::Vec3b>(i / 8, i % 8);
    EXPECT_NEAR(png->at(i % 8, i / 8), 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2], 0.51);
    EXPECT_EQ(png->at(i % 8, i / 8), bmp->at(i % 8, i / 8));
    EXPECT_EQ(png->at(i % 8, i / 8), webp->at(i % 8, i / 8));
  }
}

TEST(ReadColorImage, KeepsColoursOfAllTypes) {
  const ScratchFolder folder;
  const cv::Mat bgr(48, 64, CV_8UC3, cv::Scalar(16, 80, 160));
  for (const std::string extension : {".png", ".webp", ".ppm", ".bmp", ".tiff", ".jpg"}) {
    const auto path = folder.Write("a" + extension, Encoded(bgr, extension));
    const auto image = ReadColorImage(path);
    ASSERT_TRUE(image) << extension << ": " << image.error().why;
    ASSERT_EQ(image->width(), 64);
    ASSERT_EQ(image->height(), 48);
    const Color color = image->at(63, 47);
    const int tolerance = extension == ".jpg" ? 3 : 0;
    EXPECT_NEAR(color.r, 160, tolerance) << extension;
    EXPECT_NEAR(color.g, 80, tolerance) << extension;
    EXPECT_NEAR(color.b, 16, tolerance) << extension;
    EXPECT_EQ(ToGray(*image).at(63, 47), ReadGrayImage(path)->at(63, 47)) << extension;
  }
}

TEST(ReadColorImage, GivesGreyImagesAsReadGrayImageDoes) {
  const ScratchFolder folder;
  const cv::Mat sixteen(48, 64, CV_16UC1, cv::Scalar(0x1234));
  for (const cv::Mat& mat : {Pattern(), sixteen}) {
    const auto path = folder.Write("a.png", Encoded(mat, ".png"));
    const auto image = ReadColorImage(path);
    ASSERT_TRUE(image);
    EXPECT_TRUE(IsGray(*image));
    EXPECT_EQ(image->green.at(5, 6), ReadGrayImage(path)->at(5, 6));
  }
  EXPECT_EQ(ReadColorImage(folder / "none.png").error().why, "no such file");
  EXPECT_TRUE(ReadColorImage(folder / "a.png", ImageSize{3, 4}).error().other_size.has_value());
}

TEST(ReadGrayImage, FilesCutShortFailWithoutNoise) {
  const ScratchFolder folder;
  testing::internal::CaptureStderr();
  for (const std::string extension : {".png", ".jpg", ".webp"}) {
    const std::string whole = Encoded(Pattern(), extension);
    ASSERT_TRUE(ReadGrayImage(folder.Write("whole" + extension, whole)));
    for (const double part : {0.1, 0.5, 0.67, 0.95}) {
      const auto length = static_cast<std::size_t>(static_cast<double>(whole.size()) * part);
      const auto file = folder.Write("cut" + extension, whole.substr(0, length));
      const auto read = ReadGrayImage(file);
      ASSERT_FALSE(read) << extension << " " << part;
      EXPECT_EQ(read.error().path, file);
      EXPECT_FALSE(read.error().why.empty());
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ReadGrayImage, FindsAChangedByteOfAPng) {
  const ScratchFolder folder;
  std::string bytes = Encoded(Pattern(), ".png");
  bytes[bytes.size() / 2] ^= 1;
  const auto read = ReadGrayImage(folder.Write("a.png", bytes));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().why, HasSubstr("checksum"));
}

TEST(ReadGrayImage, TellsWhyThereIsNoImage) {
  const ScratchFolder folder;
  EXPECT_EQ(ReadGrayImage(folder / "none.png").error().why, "no such file");
  EXPECT_EQ(ReadGrayImage(folder.path()).error().why, "not a file");
  EXPECT_EQ(ReadGrayImage(folder.Write("e.png", "")).error().why, "the file is empty");
  EXPECT_THAT(ReadGrayImage(folder.Write("t.png", "some text")).error().why,
              HasSubstr("not an image"));
}

TEST(ReadGrayImage, TakesTheUpperBitsOfSixteen) {
  const ScratchFolder folder;
  cv::Mat image(2, 3, CV_16UC1, cv::Scalar(0));
  image.at<std::uint16_t>(1, 2) = 4095;
  image.at<std::uint16_t>(0, 0) = 255;
  const auto file = folder.Write("g.png", Encoded(image, ".png"));
  const auto gray = ReadGrayImage(file);
  ASSERT_TRUE(gray);
  EXPECT_EQ(gray->at(2, 1), 15);
  EXPECT_EQ(gray->at(0, 0), 0);
  EXPECT_EQ(BrightestOf16Bits(file), 4095);
}

TEST(BrightestOf16Bits, IsKnownOfSuchFilesOnly) {
  const ScratchFolder folder;
  EXPECT_EQ(BrightestOf16Bits(folder.Write("a.png", Encoded(Pattern(), ".png"))), std::nullopt);
  EXPECT_EQ(BrightestOf16Bits(folder.Write("a.jpg", Encoded(Pattern(), ".jpg"))), std::nullopt);
  EXPECT_EQ(BrightestOf16Bits(folder / "none.png"), std::nullopt);
  const cv::Mat image(8, 8, CV_16UC1, cv::Scalar(4095));
  const std::string bytes = Encoded(image, ".png");
  for (const std::size_t length : {std::size_t{0}, std::size_t{20}, bytes.size() - 20}) {
    EXPECT_EQ(BrightestOf16Bits(folder.Write("cut.png", bytes.substr(0, length))), std::nullopt);
  }
}

// Levels of a PGM file are not spread over the 16 bits that they are stored in.
TEST(BrightestOf16Bits, IsThatOfPgmFilesToo) {
  const ScratchFolder folder;
  const std::string pixels = std::string("\x0F\xFF\x01\x00\x00\x07\x00\x00", 8);
  const auto binary = folder.Write("a.pgm", "P5\n# 12 bits\n2 2\n4095\n" + pixels);
  const auto text = folder.Write("b.pgm", "P2\n2 2\n4095\n4095 256 7 0\n");
  for (const auto& file : {binary, text}) {
    EXPECT_EQ(BrightestOf16Bits(file), 4095) << file;
    const auto gray = ReadGrayImage(file);
    ASSERT_TRUE(gray) << file;
    EXPECT_EQ(gray->at(0, 0), 15) << file;
    EXPECT_EQ(gray->at(1, 0), 1) << file;
  }
  EXPECT_EQ(BrightestOf16Bits(folder.Write("c.pgm", "P5 2 2 255\nabcd")), std::nullopt);
}

// Opening a pipe waits for somebody who writes.
TEST(BrightestOf16Bits, DoesNotWaitForAPipe) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "a.png").c_str(), 0600), 0);
  EXPECT_EQ(BrightestOf16Bits(folder / "a.png"), std::nullopt);
  EXPECT_FALSE(ReadGrayImage(folder / "a.png"));
}

TEST(ReadDepthImage, DividesByTheFactorAndKeepsHoles) {
  const ScratchFolder folder;
  cv::Mat image(2, 3, CV_16UC1, cv::Scalar(0));
  image.at<std::uint16_t>(1, 2) = 5000;
  image.at<std::uint16_t>(0, 0) = 65535;
  const auto depth = ReadDepthImage(folder.Write("d.png", Encoded(image, ".png")), 5000);
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->at(2, 1), 1.0F);
  EXPECT_EQ(depth->at(0, 0), 13.107F);
  EXPECT_EQ(depth->at(1, 0), 0.0F);
}

TEST(ReadDepthImage, RefusesEightBits) {
  const ScratchFolder folder;
  const auto depth = ReadDepthImage(folder.Write("d.png", Encoded(Pattern(), ".png")), 5000);
  ASSERT_FALSE(depth);
  EXPECT_THAT(depth.error().why, HasSubstr("16-bit"));
}

TEST(ReadGrayImage, FindsTheDamagedImageOfEuroc) {
  const auto file = FindData("euroc/MH_01_easy_first250/mav0/cam1/data/1403636592913555456.png");
  if (!file) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  testing::internal::CaptureStderr();
  EXPECT_FALSE(ReadGrayImage(*file));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace plumbline
