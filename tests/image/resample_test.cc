// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/resample.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

constexpr int kWidth = 640, kHeight = 400;

using Coefficients = std::array<double, kMostCoefficients>;

Camera Distorted(DistortionModel model) {
  return Camera({.fx = 500,
                 .fy = 510,
                 .cx = 300,
                 .cy = 220,
                 .width = kWidth,
                 .height = kHeight,
                 .model = model,
                 .distortion = model == DistortionModel::kOmni
                                   ? Coefficients{0.9, -0.2, 0.05, 0.003, -0.002}
                                   : Coefficients{-0.2, 0.05, 0.003, -0.002, 0.001}});
}

// Where EXIF says that a pixel of the stored image is shown.
Eigen::Vector2d Shown(int exif, const Eigen::Vector2d& stored) {
  const double x = stored.x(), y = stored.y();
  const double right = kWidth - 1, bottom = kHeight - 1;
  switch (exif) {
    case 2:
      return {right - x, y};
    case 3:
      return {right - x, bottom - y};
    case 4:
      return {x, bottom - y};
    case 5:
      return {y, x};
    case 6:
      return {bottom - y, x};
    case 7:
      return {bottom - y, right - x};
    case 8:
      return {y, right - x};
    default:
      return stored;
  }
}

TEST(Orientation, TurnsPixelsAndCamerasAlike) {
  for (const DistortionModel model : {DistortionModel::kNone,
                                      DistortionModel::kRadTan,
                                      DistortionModel::kEquidistant,
                                      DistortionModel::kRational,
                                      DistortionModel::kDoubleSphere,
                                      DistortionModel::kOmni}) {
    const Camera stored = Distorted(model);
    for (int exif = 1; exif <= 8; ++exif) {
      const Orientation orientation = OrientationOfExif(exif);
      const Camera turned = Turned(stored, orientation);
      EXPECT_EQ(turned.width(), exif >= 5 ? kHeight : kWidth);
      for (const Eigen::Vector2d& px : {Eigen::Vector2d(20, 30), Eigen::Vector2d(500, 350)}) {
        const Eigen::Vector3d ray = *stored.Unproject(px);
        // The ray to the pixel where this one is shown, by the mirror images of the axes alone.
        Eigen::Vector3d shown = ray;
        if (orientation.transpose) std::swap(shown.x(), shown.y());
        if (orientation.flip_x) shown.x() = -shown.x();
        if (orientation.flip_y) shown.y() = -shown.y();
        const auto projected = turned.Project(shown);
        ASSERT_TRUE(projected);
        EXPECT_LT((*projected - Shown(exif, px)).norm(), 1e-6) << exif;
        if (orientation.Mirrors()) continue;
        EXPECT_LT((TurnedFromStored(orientation) * ray - shown).norm(), 1e-12) << exif;
      }
      EXPECT_EQ(Turned(turned, Inverse(orientation)).intrinsics().width, kWidth);
      const CameraIntrinsics back = Turned(turned, Inverse(orientation)).intrinsics();
      EXPECT_NEAR(back.cx, stored.intrinsics().cx, 1e-9);
      EXPECT_NEAR(back.cy, stored.intrinsics().cy, 1e-9);
      EXPECT_EQ(back.distortion, stored.intrinsics().distortion);
    }
  }
}

TEST(Orientation, IsToldInWords) {
  const std::vector<std::string> words = {"as stored",
                                          "mirrored",
                                          "turned by 180 degrees clockwise",
                                          "turned by 180 degrees clockwise and mirrored",
                                          "turned by 90 degrees clockwise and mirrored",
                                          "turned by 90 degrees clockwise",
                                          "turned by 270 degrees clockwise and mirrored",
                                          "turned by 270 degrees clockwise"};
  for (int exif = 1; exif <= 8; ++exif) {
    EXPECT_EQ(Describe(OrientationOfExif(exif)), words[static_cast<std::size_t>(exif) - 1]);
  }
  EXPECT_TRUE(OrientationOfExif(0).IsIdentity());
  EXPECT_TRUE(OrientationOfExif(9).IsIdentity());
}

TEST(Orientation, KeepsTheBodyWhereItIs) {
  Calibration stored;
  stored.left = Distorted(DistortionModel::kRadTan);
  stored.body_from_left = Rigid3{ExpSo3({0.1, -0.4, 0.3}), {0.2, 0.1, -0.3}};
  const Orientation quarter = ClockwiseTurn(90);
  const Calibration turned = Turned(stored, quarter);
  const Eigen::Vector3d point(0.3, -0.2, 2);  // in the frame of the stored image
  const Eigen::Vector3d same = TurnedFromStored(quarter) * point;
  EXPECT_LT((*turned.body_from_left * same - *stored.body_from_left * point).norm(), 1e-12);
  EXPECT_EQ(Turned(stored, OrientationOfExif(2)).body_from_left->translation,
            stored.body_from_left->translation);
  stored.right = stored.left;
  EXPECT_THROW(Turned(stored, quarter), BugError);
}

GrayImage NoiseImage(int width, int height) {
  GrayImage image(width, height);
  Rng rng(5, "resample_test");
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<std::uint8_t>(rng.Index(256));
  }
  return image;
}

// The rows of an image of letters, one behind the other.
std::string Rows(const GrayImage& image) {
  std::string rows;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) rows += static_cast<char>(image.at(x, y));
    rows += ' ';
  }
  return rows;
}

TEST(TurnedImage, HasEachOrientationOfExif) {
  GrayImage image(3, 2);
  std::copy_n("abcdef", 6, image.data());
  const std::vector<std::string> expected = {"abc def ",
                                             "cba fed ",
                                             "fed cba ",
                                             "def abc ",
                                             "ad be cf ",
                                             "da eb fc ",
                                             "fc eb da ",
                                             "cf be ad "};
  for (int exif = 1; exif <= 8; ++exif) {
    const Orientation orientation = OrientationOfExif(exif);
    const GrayImage turned = Turned(image, orientation);
    EXPECT_EQ(Rows(turned), expected[static_cast<std::size_t>(exif) - 1]) << exif;
    EXPECT_EQ(Rows(Turned(turned, Inverse(orientation))), "abc def ") << exif;
  }
}

// The part of the unit interval at i that lies in [begin, end].
double Part(int i, double begin, double end) {
  return std::max(0.0, std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i)));
}

TEST(AreaAveraged, IsTheMeanOfTheArea) {
  for (const auto& [width, height] : {std::pair{23, 17}, {8, 5}, {46, 34}, {1, 1}, {45, 34}}) {
    const GrayImage image = NoiseImage(46, 34);
    const GrayImage reduced = AreaAveraged(image, width, height);
    ASSERT_EQ(reduced.width(), width);
    ASSERT_EQ(reduced.height(), height);
    const double sx = 46.0 / width, sy = 34.0 / height;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        double sum = 0;
        for (int y = 0; y < 34; ++y) {
          for (int x = 0; x < 46; ++x) {
            sum += image.at(x, y) * Part(x, u * sx, (u + 1) * sx) * Part(y, v * sy, (v + 1) * sy);
          }
        }
        EXPECT_NEAR(reduced.at(u, v), sum / (sx * sy), 0.5 + 1e-6);
      }
    }
  }
  EXPECT_EQ(Rows(AreaAveraged(NoiseImage(46, 34), 46, 34)), Rows(NoiseImage(46, 34)));
}

TEST(AreaAveraged, KeepsTheBrightestOfTheLargest) {
  const GrayImage reduced = AreaAveraged(GrayImage(99'999, 3, 255), 1000, 2);
  EXPECT_TRUE(std::all_of(reduced.data(), reduced.data() + 2000, [](int p) { return p == 255; }));
}

TEST(NearestPixels, MixesNothing) {
  DepthImage depth(9, 4, 1.0F);
  for (int y = 0; y < 4; ++y) {
    for (int x = 5; x < 9; ++x) depth.at(x, y) = 7.0F;
  }
  depth.at(1, 1) = 0;
  const DepthImage reduced = NearestPixels(depth, 3, 1);
  EXPECT_EQ(reduced.at(0, 0), 1.0F);
  EXPECT_EQ(reduced.at(1, 0), 1.0F);  // column 4, the middle of columns 3 to 5
  EXPECT_EQ(reduced.at(2, 0), 7.0F);
  depth.at(1, 2) = 0;
  EXPECT_EQ(NearestPixels(depth, 3, 1).at(0, 0), 0.0F);  // not measured there
}

}  // namespace

}  // namespace plumbline
