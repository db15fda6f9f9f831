// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/image_codecs.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

// Smooth, with noise: as images are.
cv::Mat TestImage(int type) {
  Rng rng(3, "codecs");
  cv::Mat image(37, 53, type);
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols * channels; ++x) {
      const double value =
          0.5 + 0.3 * std::sin(0.1 * x) + 0.1 * std::cos(0.3 * y) + rng.Uniform(-0.1, 0.1);
      if (image.depth() == CV_16U) {
        image.ptr<std::uint16_t>(y)[x] = static_cast<std::uint16_t>(65'535 * value);
      } else {
        image.ptr<std::uint8_t>(y)[x] = static_cast<std::uint8_t>(255 * value);
      }
    }
  }
  return image;
}

std::vector<std::uint8_t> Encoded(const std::string& extension,
                                  const cv::Mat& image,
                                  const std::vector<int>& parameters = {}) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes, parameters);
  return bytes;
}

cv::Mat DecodedByOpenCv(const std::string& bytes) {
  return cv::imdecode(
      cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data())),
      cv::IMREAD_UNCHANGED);
}

void ExpectEqual(const cv::Mat& image, const cv::Mat& expected) {
  ASSERT_EQ(image.type(), expected.type());
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0);
}

TEST(DecodePng, GivesWhatOpenCvGives) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1}) {
    const cv::Mat image = TestImage(type);
    ExpectEqual(DecodePng(Encoded(".png", image)), image);
  }
  const auto one_bit = Encoded(".png", TestImage(CV_8UC1) > 128, {cv::IMWRITE_PNG_BILEVEL, 1});
  ExpectEqual(DecodePng(one_bit), cv::imdecode(one_bit, cv::IMREAD_UNCHANGED));
}

TEST(DecodePng, LeavesAlphaOut) {
  cv::Mat image;
  cv::cvtColor(TestImage(CV_8UC3), image, cv::COLOR_BGR2BGRA);
  image.at<cv::Vec4b>(3, 3)[3] = 7;
  ExpectEqual(DecodePng(Encoded(".png", image)), TestImage(CV_8UC3));
}

TEST(DecodePng, IsEmptyForOtherKindsAndForDamage) {
  EXPECT_TRUE(DecodePng({}).empty());
  EXPECT_TRUE(DecodePng(Encoded(".jpg", TestImage(CV_8UC1))).empty());
  EXPECT_TRUE(DecodePng(Encoded(".png", TestImage(CV_16UC3))).empty());
  auto bytes = Encoded(".png", TestImage(CV_8UC1));
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_TRUE(DecodePng(bytes).empty());
  bytes.resize(bytes.size() / 2);
  EXPECT_TRUE(DecodePng(bytes).empty());
}

TEST(DecodeJpeg, GivesWhatOpenCvGives) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const int progressive : {0, 1}) {
      const auto bytes =
          Encoded(".jpg",
                  TestImage(type),
                  {cv::IMWRITE_JPEG_QUALITY, 80, cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
      ExpectEqual(DecodeJpeg(bytes), cv::imdecode(bytes, cv::IMREAD_UNCHANGED));
    }
  }
}

TEST(DecodeJpeg, IsEmptyForOtherBytes) {
  EXPECT_TRUE(DecodeJpeg({}).empty());
  EXPECT_TRUE(DecodeJpeg(Encoded(".png", TestImage(CV_8UC1))).empty());
}

TEST(DecodeWebp, GivesWhatOpenCvGives) {
  cv::Mat with_alpha;
  cv::cvtColor(TestImage(CV_8UC3), with_alpha, cv::COLOR_BGR2BGRA);
  with_alpha.at<cv::Vec4b>(3, 3)[3] = 7;
  constexpr int kLossless = 101;
  for (const cv::Mat& image : {TestImage(CV_8UC1), TestImage(CV_8UC3), with_alpha}) {
    for (const int quality : {80, kLossless}) {
      const auto bytes = Encoded(".webp", image, {cv::IMWRITE_WEBP_QUALITY, quality});
      ExpectEqual(DecodeWebp(bytes), cv::imdecode(bytes, cv::IMREAD_COLOR));
    }
  }
}

TEST(DecodeWebp, IsEmptyForOtherBytes) {
  EXPECT_TRUE(DecodeWebp({}).empty());
  EXPECT_TRUE(DecodeWebp(Encoded(".png", TestImage(CV_8UC1))).empty());
}

TEST(EncodePng, KeepsThePixels) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1}) {
    const cv::Mat image = TestImage(type);
    ExpectEqual(DecodedByOpenCv(EncodePng(image)), image);
  }
  const cv::Mat part = TestImage(CV_8UC1)(cv::Rect(3, 4, 20, 10));
  ExpectEqual(DecodedByOpenCv(EncodePng(part)), part);
}

TEST(EncodePng, IsAboutAsSmallAsOpenCvs) {
  cv::Mat image;
  cv::resize(TestImage(CV_8UC1), image, {}, 12, 12, cv::INTER_CUBIC);
  EXPECT_LT(static_cast<double>(EncodePng(image).size()),
            1.05 * static_cast<double>(Encoded(".png", image).size()));
}

TEST(EncodeJpeg, KeepsWhatTheQualityPromises) {
  const cv::Mat image = TestImage(CV_8UC1);
  const std::string best = EncodeJpeg(image, 98), small = EncodeJpeg(image, 60);
  EXPECT_LT(small.size(), best.size());
  ExpectEqual(
      DecodedByOpenCv(small),
      cv::imdecode(Encoded(".jpg", image, {cv::IMWRITE_JPEG_QUALITY, 60}), cv::IMREAD_UNCHANGED));
}

}  // namespace
}  // namespace plumbline
