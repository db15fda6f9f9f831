// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/sensor.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kSensorSize = 128;

struct Statistics {
  double mean = 0, sigma = 0;
};

Statistics Of(const GrayImage& image) {
  double sum = 0, squares = 0;
  const int count = image.width() * image.height();
  for (int i = 0; i < count; ++i) {
    sum += image.data()[i];
    squares += double(image.data()[i]) * image.data()[i];
  }
  return {sum / count, std::sqrt(squares / count - sum * sum / count / count)};
}

SensorModel Flat(double noise) {
  SensorModel model;
  model.vignetting = 0;
  model.noise = noise;
  return model;
}

TEST(Expose, IsLinearBelowTheShoulder) {
  for (const float light : {10.0F, 60.0F, 130.0F, 200.0F}) {
    EXPECT_EQ(Of(Expose(Image<float>(4, 4, light), Flat(0), 1, 1)).mean, light);
  }
  SensorModel bright = Flat(0);
  bright.gain = 2;
  EXPECT_EQ(Of(Expose(Image<float>(4, 4, 50), bright, 1, 1)).mean, 100);
}

TEST(Expose, BendsOffInsteadOfCutting) {
  double last = 0;
  for (const float light : {230.0F, 250.0F, 270.0F, 290.0F}) {
    const double value = Of(Expose(Image<float>(4, 4, light), Flat(0), 1, 1)).mean;
    EXPECT_GT(value, last);
    EXPECT_LT(value, 255);
    last = value;
  }
  EXPECT_EQ(Of(Expose(Image<float>(4, 4, 5000), Flat(0), 1, 1)).mean, 255);
}

TEST(Expose, NoiseGrowsWithTheRootOfTheLight) {
  double last = 0;
  for (const float light : {20.0F, 80.0F, 180.0F}) {
    const Statistics made =
        Of(Expose(Image<float>(kSensorSize, kSensorSize, light), Flat(1), 1, 1));
    EXPECT_NEAR(made.mean, light, 0.1);
    // Read noise, shot noise, unequal pixels, rounding.
    const double electrons = 12'000 * light / 255;
    const double expected = std::sqrt(std::pow(255 / 12'000.0, 2) * (1600 + electrons) +
                                      std::pow(0.006 * light, 2) + 1 / 12.0);
    EXPECT_NEAR(made.sigma, expected, 0.04 * expected) << light;
    EXPECT_GT(made.sigma, last);
    last = made.sigma;
  }
}

TEST(Expose, PixelsOfOneChipKeepTheirGain) {
  const Image<float> light(kSensorSize, kSensorSize, 200);
  const auto correlation = [&](std::uint64_t chip) {
    const GrayImage a = Expose(light, Flat(1), 1, 1), b = Expose(light, Flat(1), chip, 2);
    double sum = 0;
    for (int i = 0; i < kSensorSize * kSensorSize; ++i) {
      sum += (double(a.data()[i]) - 200) * (double(b.data()[i]) - 200);
    }
    return sum / (kSensorSize * kSensorSize);
  };
  EXPECT_NEAR(correlation(1), 1.2 * 1.2, 0.3);  // the variance of the gains alone
  EXPECT_NEAR(correlation(2), 0, 0.2);
}

TEST(Expose, CornersGetLessLight) {
  SensorModel model = Flat(0);
  model.vignetting = 0.25;
  const GrayImage image = Expose(Image<float>(201, 101, 200), model, 1, 1);
  EXPECT_EQ(image.at(100, 50), 200);
  EXPECT_EQ(image.at(0, 0), 150);
}

TEST(Expose, GammaBrightensTheDark) {
  SensorModel model = Flat(0);
  model.gamma = 2.2;
  const double value = Of(Expose(Image<float>(4, 4, 51), model, 1, 1)).mean;
  EXPECT_EQ(value, std::round(255 * std::pow(0.2, 1 / 2.2)));
}

TEST(Expose, TheLensSpreadsAPoint) {
  Image<float> light(9, 9);
  light.at(4, 4) = 200;
  SensorModel model = Flat(0);
  model.blur_px = 0.5;
  const GrayImage image = Expose(light, model, 1, 1);
  double sum = 0, variance = 0;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      sum += image.at(x, y);
      variance += image.at(x, y) * (x - 4) * (x - 4);
    }
  }
  EXPECT_NEAR(sum, 200, 3);
  EXPECT_NEAR(variance / sum, 0.25, 0.01);
}

TEST(SenseDepth, ErrorsGrowWithTheSquareOfTheDistance) {
  for (const float depth : {1.0F, 3.0F}) {
    const DepthImage sensed = SenseDepth(DepthImage(kSensorSize, kSensorSize, depth), 1, 5);
    double sum = 0, squares = 0;
    for (int i = 0; i < kSensorSize * kSensorSize; ++i) {
      const double error = static_cast<double>(sensed.data()[i] - depth);
      sum += error;
      squares += error * error;
    }
    const double sigma = std::sqrt(squares / (kSensorSize * kSensorSize));
    const double expected = depth * depth * std::hypot(0.0014, 0.0028 / std::sqrt(12.0));
    EXPECT_NEAR(sigma, expected, 0.15 * expected) << depth;
    EXPECT_LT(std::abs(sum) / (kSensorSize * kSensorSize), 0.3 * expected);
  }
}

TEST(SenseDepth, HasARangeAndCanBeExact) {
  DepthImage depth(4, 1);
  depth.at(0, 0) = 0;
  depth.at(1, 0) = 0.2F;
  depth.at(2, 0) = 2.5F;
  depth.at(3, 0) = 12;
  const DepthImage sensed = SenseDepth(depth, 0, 1);
  EXPECT_EQ(sensed.at(0, 0), 0);
  EXPECT_EQ(sensed.at(1, 0), 0);
  EXPECT_NEAR(sensed.at(2, 0), 2.5, 1e-6);
  EXPECT_EQ(sensed.at(3, 0), 0);
}

}  // namespace
}  // namespace plumbline
