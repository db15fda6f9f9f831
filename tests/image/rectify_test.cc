// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/rectify.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/image/opencv_bridge.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
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

// OpenCV's result with maps in fixed point, which Rectifier has as well.
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

using ::testing::HasSubstr;

double InvalidFraction(const GrayImage& mask) {
  double invalid = 0;
  for (int y = 0; y < mask.height(); ++y) {
    invalid += static_cast<double>(std::count(mask.row(y), mask.row(y) + mask.width(), 0));
  }
  return invalid / (static_cast<double>(mask.width()) * mask.height());
}

Calibration TumCalibration() {
  Calibration calibration;
  calibration.left = Camera({.fx = 517.306408,
                             .fy = 516.469215,
                             .cx = 318.643040,
                             .cy = 255.313989,
                             .width = 640,
                             .height = 480,
                             .model = DistortionModel::kRadTan,
                             .distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}});
  calibration.depth_factor = 5000;
  return calibration;
}

Calibration KittiCalibration() {
  Calibration calibration;
  calibration.left = Camera(
      {.fx = 707.0912, .fy = 707.0912, .cx = 601.8873, .cy = 183.1104, .width = 124, .height = 37});
  calibration.right = calibration.left;
  calibration.right_from_left.translation = {-0.537, 0, 0};
  calibration.rectified = true;
  return calibration;
}

TEST(Rectifier, TheTurnOfThePairIsARotation) {
  Calibration off = EurocCalibration();
  off.right_from_left.rotation.coeffs() *= 0.994;
  const Rectifier exact(EurocCalibration()), normalized(off);
  EXPECT_NEAR(normalized.camera().baseline, exact.camera().baseline, 1e-12);
  EXPECT_LT(
      AngularDistance(normalized.rectified_left_from_left(), exact.rectified_left_from_left()),
      1e-7);
  off.right_from_left.rotation.coeffs() *= 2;
  EXPECT_THROW(Rectifier{off}, InputError);
}

TEST(Rectifier, EurocPairHasEqualRowsAndTheDisparityOfTheDepth) {
  const Calibration calibration = EurocCalibration();
  const Rectifier rectifier(calibration);
  const RectifiedCamera& ideal = rectifier.camera();
  Rng rng(1);
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const double z = rng.Uniform(0.5, 20);
    const Eigen::Vector3d point(rng.Uniform(-0.8, 0.8) * z, rng.Uniform(-0.5, 0.5) * z, z);
    const auto raw_left = calibration.left.Project(point);
    const auto raw_right = calibration.right->Project(calibration.right_from_left * point);
    if (!raw_left || !raw_right || !calibration.left.Contains(*raw_left) ||
        !calibration.right->Contains(*raw_right)) {
      continue;
    }
    ++seen;
    const auto left = rectifier.RectifyLeft(*raw_left);
    const auto right = rectifier.RectifyRight(*raw_right);
    ASSERT_TRUE(left && right);
    const Eigen::Vector3d turned = rectifier.rectified_left_from_left() * point;
    EXPECT_LT((*left - ideal.Project(turned)).norm(), 1e-8);
    EXPECT_NEAR(left->y(), right->y(), 1e-8);
    EXPECT_NEAR(left->x() - right->x(), ideal.DisparityFromDepth(turned.z()), 1e-8);
  }
  EXPECT_GT(seen, 1000);
}

TEST(Rectifier, EurocKeepsTheViewWithoutInvalidBorders) {
  const Rectifier rectifier(EurocCalibration());
  const RectifiedCamera& ideal = rectifier.camera();
  EXPECT_NEAR(ideal.fx, 435, 12);
  EXPECT_EQ(ideal.fx, ideal.fy);
  EXPECT_NEAR(ideal.baseline, 0.11007, 1e-4);
  EXPECT_LT(InvalidFraction(rectifier.left_mask()), 1e-3);
  EXPECT_LT(InvalidFraction(rectifier.right_mask()), 1e-3);
  // The mounting is nearly parallel: the picture is hardly turned.
  EXPECT_LT(LogSo3(rectifier.rectified_left_from_left()).norm(), 0.03);
}

// A smooth picture of which every pixel can be computed.
double Pattern(const Eigen::Vector2d& px) {
  return 128 + 100 * std::sin(0.05 * px.x()) * std::cos(0.07 * px.y());
}

TEST(Rectifier, RemapsPixelsToWhereThePointsLie) {
  const Calibration calibration = EurocCalibration();
  const Rectifier rectifier(calibration);
  const RectifiedCamera& ideal = rectifier.camera();
  SensorFrame raw;
  raw.stamp_ns = 77;
  raw.left = GrayImage(752, 480);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 752; ++u) {
      // Value of the ideal picture where this raw pixel comes to lie.
      const auto px = rectifier.RectifyLeft({u, v});
      ASSERT_TRUE(px);
      raw.left.at(u, v) = static_cast<std::uint8_t>(std::lround(Pattern(*px)));
    }
  }
  raw.right = raw.left;
  const RectifiedFrame frame = rectifier.Apply(raw);
  EXPECT_EQ(frame.stamp_ns, 77);
  ASSERT_TRUE(frame.right);
  EXPECT_FALSE(frame.depth);
  double worst = 0;
  for (int v = 0; v < ideal.height; ++v) {
    for (int u = 0; u < ideal.width; ++u) {
      if (rectifier.left_mask().at(u, v) == 0) continue;
      worst = std::max(worst, std::abs(frame.left.at(u, v) - Pattern({u, v})));
    }
  }
  // Half a grey level twice, 1/64 px of rounding at up to 7 grey levels a pixel, and interpolation.
  EXPECT_LT(worst, 2.0);
}

TEST(Rectifier, UndistortsMonoWithoutTurning) {
  Calibration calibration = EurocCalibration();
  calibration.right.reset();
  const Rectifier rectifier(calibration);
  EXPECT_EQ(LogSo3(rectifier.rectified_left_from_left()).norm(), 0);
  EXPECT_EQ(rectifier.camera().baseline, 0);
  EXPECT_TRUE(rectifier.right_mask().empty());
  EXPECT_FALSE(rectifier.RectifyRight({100, 100}));
  const Eigen::Vector3d point(0.3, -0.2, 2);
  EXPECT_LT(
      (*rectifier.RectifyLeft(*calibration.left.Project(point)) - rectifier.camera().Project(point))
          .norm(),
      1e-8);
}

// TUM-VI's left camera, of 195 degrees.
Calibration FisheyeCalibration() {
  Calibration calibration;
  calibration.left = Camera({.fx = 190.98,
                             .fy = 190.97,
                             .cx = 254.93,
                             .cy = 256.90,
                             .width = 512,
                             .height = 512,
                             .model = DistortionModel::kEquidistant,
                             .distortion = {0.00348, 0.000715, -0.00205, 0.0002}});
  return calibration;
}

TEST(Rectifier, AWideLensKeepsTheResolutionOfItsMiddle) {
  Calibration calibration = FisheyeCalibration();
  const Rectifier rectifier(calibration);
  const RectifiedCamera& view = rectifier.camera();
  EXPECT_NEAR(view.fx, 190.975, 1e-9);
  EXPECT_NEAR(view.width, 2 * 190.975 * std::tan(55 * M_PI / 180), 2);
  EXPECT_EQ(view.width, view.height);
  EXPECT_EQ(InvalidFraction(rectifier.left_mask()), 0);
  const Eigen::Vector3d wide(1.4, -1.2, 1);
  EXPECT_LT((*rectifier.RectifyLeft(*calibration.left.Project(wide)) - view.Project(wide)).norm(),
            1e-8);
  const Rectifier::Coverage coverage = rectifier.LeftCoverage();
  EXPECT_NEAR(coverage.across_deg, 110, 0.5);
  EXPECT_NEAR(coverage.down_deg, 110, 0.5);
  EXPECT_NEAR(coverage.resolution, 1, 1e-12);
  EXPECT_NEAR(coverage.used, 0.435, 0.01);
  EXPECT_GT(coverage.lens_deg, 190);
  calibration.view_angle_deg = 90;
  EXPECT_NEAR(Rectifier(calibration).camera().width, 2 * 190.975, 2);
  EXPECT_NEAR(Rectifier(calibration).camera().fx, 190.975, 1e-9);
  calibration.view_angle_deg = 170;
  EXPECT_THROW(Rectifier{calibration}, InputError);
}

TEST(Rectifier, EveryLensIsCutOutWhereItHasPixels) {
  const std::vector<CameraIntrinsics> lenses = {
      {.model = DistortionModel::kRational,
       .distortion = {8.5, 4.2, 0.0002, -0.0001, 0.21, 8.85, 7.06, 1.1}},
      {.model = DistortionModel::kFov, .distortion = {0.93}},
      {.model = DistortionModel::kDoubleSphere, .distortion = {-0.18, 0.59}},
      {.model = DistortionModel::kEucm, .distortion = {0.63, 1.04}},
      {.model = DistortionModel::kOmni, .distortion = {0.9, -0.2, 0.05, 0.001, -0.0005}}};
  for (CameraIntrinsics in : lenses) {
    in.fx = in.fy = 320;
    in.cx = 318;
    in.cy = 243;
    in.width = 640;
    in.height = 480;
    Calibration calibration;
    calibration.left = Camera(in);
    const Rectifier rectifier(calibration);
    const RectifiedCamera& view = rectifier.camera();
    EXPECT_NEAR(view.fx, calibration.left.CentreFocal(), 1e-9) << FormOf(in.model).name;
    EXPECT_LT(InvalidFraction(rectifier.left_mask()), 0.02) << FormOf(in.model).name;
    // That of Mei shows 200 degrees, the others 110 to 140.
    const bool wide = in.model == DistortionModel::kOmni;
    EXPECT_GT(rectifier.LeftCoverage().used, wide ? 0.3 : 0.75) << FormOf(in.model).name;
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.5, -0.4, 1), {-0.3, 0.2, 1}, {0, 0, 2}}) {
      const auto seen = rectifier.RectifyLeft(*calibration.left.Project(p));
      ASSERT_TRUE(seen);
      EXPECT_LT((*seen - view.Project(p)).norm(), 1e-8) << FormOf(in.model).name;
    }
  }
}

TEST(Rectifier, ALensWithoutRaysAtTheSidesIsCutWhereItEnds) {
  CameraIntrinsics in{.fx = 700,
                      .fy = 700,
                      .cx = 640,
                      .cy = 360,
                      .width = 1280,
                      .height = 720,
                      .model = DistortionModel::kRadTan};
  in.distortion = {-0.35};  // the radius stops rising at 0.65: nothing is at the left and right
  Calibration calibration;
  calibration.left = Camera(in);
  ASSERT_FALSE(calibration.left.Ray({0, 360}));
  const Rectifier rectifier(calibration);
  EXPECT_LT(InvalidFraction(rectifier.left_mask()), 0.1);
  EXPECT_GT(rectifier.LeftCoverage().used, 0.5);
}

TEST(Rectifier, AViewAngleCutsOtherImagesToo) {
  Calibration calibration = KittiCalibration();
  const RectifiedCamera whole = Rectifier(calibration).camera();
  calibration.view_angle_deg = 10;
  const Rectifier cut(calibration);
  // The image has 10 degrees across and 3 down.
  EXPECT_NEAR(cut.camera().fx, whole.fx, 1e-9);
  EXPECT_NEAR(cut.camera().baseline, whole.baseline, 1e-12);
}

TEST(Rectifier, MasksGoTheWayOfTheImages) {
  const Calibration calibration = EurocCalibration();
  const Rectifier rectifier(calibration);
  SensorFrame raw;
  raw.left = GrayImage(752, 480, 90);
  raw.right = raw.left;
  GrayImage mask(752, 480, 1);  // all but 0 is used
  for (int v = 100; v < 220; ++v) {
    for (int u = 300; u < 420; ++u) mask.at(u, v) = 0;
  }
  raw.left_mask = std::make_shared<const GrayImage>(mask);
  const RectifiedFrame frame = rectifier.Apply(raw);
  EXPECT_TRUE(frame.right_mask.empty());
  const Eigen::Quaterniond left_from_rectified = rectifier.rectified_left_from_left().conjugate();
  int black = 0;
  for (int v = 0; v < rectifier.camera().height; v += 3) {
    for (int u = 0; u < rectifier.camera().width; u += 3) {
      const auto px =
          *calibration.left.Project(left_from_rectified * rectifier.camera().Unproject({u, v}));
      const double off = std::max(std::abs(px.x() - 359.5) - 60, std::abs(px.y() - 159.5) - 60);
      EXPECT_FALSE(off < -1 && frame.left_mask.at(u, v) != 0) << u << " " << v;
      if (off > 2 && rectifier.left_mask().at(u, v) != 0) {
        EXPECT_EQ(frame.left_mask.at(u, v), 255) << u << " " << v;
      }
      black += frame.left_mask.at(u, v) == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(black, 1000);
  raw.left_mask = std::make_shared<const GrayImage>(751, 480);
  EXPECT_THROW((void)rectifier.Apply(raw), InputError);
}

// The second camera looks 40 degrees to the side: no ideal image has only real pixels.
TEST(Rectifier, MasksWhatNoCameraSaw) {
  Calibration calibration = EurocCalibration();
  calibration.right_from_left.rotation = ExpSo3({0, 0.7, 0});
  calibration.right_from_left.translation =
      -(calibration.right_from_left.rotation * Eigen::Vector3d(0.11, 0, 0));
  const Rectifier rectifier(calibration);
  EXPECT_GT(InvalidFraction(rectifier.left_mask()), 0.02);
  EXPECT_LT(InvalidFraction(rectifier.left_mask()), 0.7);
  const RectifiedCamera& ideal = rectifier.camera();
  const Eigen::Quaterniond left_from_rectified = rectifier.rectified_left_from_left().conjugate();
  for (int v = 0; v < ideal.height; v += 17) {
    for (int u = 0; u < ideal.width; u += 17) {
      const auto raw = calibration.left.Project(left_from_rectified * ideal.Unproject({u, v}));
      const bool seen = raw && calibration.left.Contains(*raw);
      EXPECT_EQ(rectifier.left_mask().at(u, v) != 0, seen) << u << " " << v;
    }
  }
}

TEST(Rectifier, RemapsDepthByNearestNeighbour) {
  const Calibration calibration = TumCalibration();
  const Rectifier rectifier(calibration);
  EXPECT_EQ(rectifier.camera().baseline, 0.08);
  SensorFrame raw;
  raw.left = GrayImage(640, 480, 9);
  raw.depth = DepthImage(640, 480);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) raw.depth->at(u, v) = u < 300 ? 1.0F : 3.0F;
  }
  const RectifiedFrame frame = rectifier.Apply(raw);
  ASSERT_TRUE(frame.depth);
  int checked = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const float z = frame.depth->at(u, v);
      if (rectifier.left_mask().at(u, v) == 0) continue;
      EXPECT_TRUE(z == 1.0F || z == 3.0F) << "no value between two surfaces, found " << z;
      const auto raw_px = calibration.left.Project(rectifier.camera().Unproject({u, v}));
      if (std::abs(raw_px->x() - 299.5) < 0.6) continue;
      EXPECT_EQ(z, raw_px->x() < 299.5 ? 1.0F : 3.0F);
      ++checked;
    }
  }
  EXPECT_GT(checked, 280000);
}

TEST(Rectifier, HandsIdealImagesThroughWithoutCopy) {
  const Rectifier rectifier(KittiCalibration());
  EXPECT_EQ(rectifier.camera().fx, 707.0912);
  EXPECT_EQ(rectifier.camera().cx, 601.8873);
  EXPECT_EQ(rectifier.camera().baseline, 0.537);
  EXPECT_EQ(InvalidFraction(rectifier.left_mask()), 0);
  EXPECT_EQ(InvalidFraction(rectifier.right_mask()), 0);
  SensorFrame raw;
  raw.left = GrayImage(124, 37, 1);
  raw.right = GrayImage(124, 37, 2);
  const std::uint8_t* pixels = raw.left.data();
  const RectifiedFrame frame = rectifier.Apply(std::move(raw));
  EXPECT_EQ(frame.left.data(), pixels);
  EXPECT_EQ(frame.right->at(3, 3), 2);
}

TEST(Rectifier, MakesOneCameraOfAnUndistortedPairWithTwoPrincipalPoints) {
  Calibration calibration = KittiCalibration();
  CameraIntrinsics shifted = calibration.left.intrinsics();
  shifted.cx += 3;
  calibration.right = Camera(shifted);
  const Rectifier rectifier(calibration);
  const Eigen::Vector3d point(-0.5, -0.2, 9);  // the size above is a corner of the real image
  const auto left = rectifier.RectifyLeft(*calibration.left.Project(point));
  const auto right =
      rectifier.RectifyRight(*calibration.right->Project(calibration.right_from_left * point));
  EXPECT_NEAR(left->x() - right->x(), rectifier.camera().DisparityFromDepth(9), 1e-9);
}

TEST(Rectifier, NamesExpectedAndFoundSizes) {
  const Rectifier stereo(EurocCalibration());
  SensorFrame raw;
  raw.left = GrayImage(640, 480);
  EXPECT_THAT(MessageOf([&] { (void)stereo.Apply(raw); }),
              HasSubstr("left image: expected 752x480, found 640x480"));
  raw.left = GrayImage(752, 480);
  raw.right = GrayImage(752, 481);
  EXPECT_THAT(MessageOf([&] { (void)stereo.Apply(raw); }),
              HasSubstr("right image: expected 752x480, found 752x481"));
  const Rectifier rgbd(TumCalibration());
  raw.left = GrayImage(640, 480);
  raw.depth = DepthImage(320, 240);
  EXPECT_THAT(MessageOf([&] { (void)rgbd.Apply(raw); }),
              HasSubstr("depth image: expected 640x480, found 320x240"));
}

TEST(Rectifier, RefusesDistortedDepthImagesThatAreTooWide) {
  Calibration calibration = TumCalibration();
  CameraIntrinsics wide = calibration.left.intrinsics();
  wide.width = 34000;
  wide.height = 4;
  calibration.left = Camera(wide);
  EXPECT_THAT(MessageOf([&] { Rectifier{calibration}; }),
              HasSubstr("at most 32766 pixels a side, found 34000x4"));
}

TEST(Rectifier, RefusesPairsThatContradictThemselves) {
  Calibration swapped = EurocCalibration();
  swapped.right_from_left = Inverse(swapped.right_from_left);
  EXPECT_THAT(MessageOf([&] { Rectifier{swapped}; }), HasSubstr("to the right (+x)"));
  Calibration together = EurocCalibration();
  together.right_from_left.translation *= 1e-300;
  EXPECT_THAT(MessageOf([&] { Rectifier{together}; }), HasSubstr("expected a baseline from"));
  Calibration turned = KittiCalibration();
  turned.right_from_left.rotation = ExpSo3({0, 0.01, 0});
  EXPECT_THAT(MessageOf([&] { Rectifier{turned}; }), HasSubstr("declared rectified"));
  Calibration distorted = EurocCalibration();
  distorted.rectified = true;
  EXPECT_THAT(MessageOf([&] { Rectifier{distorted}; }), HasSubstr("no lens distortion"));
  Calibration sizes = KittiCalibration();
  CameraIntrinsics smaller = sizes.left.intrinsics();
  smaller.width = 100;
  sizes.right = Camera(smaller);
  EXPECT_THAT(MessageOf([&] { Rectifier{sizes}; }), HasSubstr("expected a right camera of 124x37"));
}

TEST(Rectifier, AlignsTheRowsOfARealPair) {
  const auto folder = FindData("euroc/MH_01_easy_first250/mav0");
  if (!folder) GTEST_SKIP() << "the EuRoC sequence is not there";
  const std::string name = "data/1403636584763555584.webp";
  const auto read = [&](const char* camera) {
    return cv::imread((*folder / camera / name).string(), cv::IMREAD_GRAYSCALE);
  };
  SensorFrame raw;
  raw.left = ToImage<std::uint8_t>(read("cam0"));
  raw.right = ToImage<std::uint8_t>(read("cam1"));
  const RectifiedFrame frame = Rectifier(EurocCalibration()).Apply(raw);
  // Blocks of strong gradient in both directions must match best in their own row: by the sum of
  // absolute differences over all disparities, at row offsets -2 ... 2.
  std::array<int, 5> votes{};
  constexpr int kHalf = 7;
  for (int y = 60; y < 420; y += 30) {
    for (int x = 160; x < 720; x += 20) {
      double texture = 0;
      for (int dy = -kHalf; dy <= kHalf; ++dy) {
        for (int dx = -kHalf; dx <= kHalf; ++dx) {
          texture +=
              std::abs(frame.left.at(x + dx, y + dy + 1) - frame.left.at(x + dx, y + dy - 1));
        }
      }
      if (texture < 10 * 225) continue;
      int best_offset = 0;
      double best = 1e9;
      for (int offset = -2; offset <= 2; ++offset) {
        for (int d = 0; d < 100; ++d) {
          double sum = 0;
          for (int dy = -kHalf; dy <= kHalf; ++dy) {
            const std::uint8_t* l = frame.left.row(y + dy) + x;
            const std::uint8_t* r = frame.right->row(y + dy + offset) + x - d;
            for (int dx = -kHalf; dx <= kHalf; ++dx) sum += std::abs(l[dx] - r[dx]);
          }
          if (sum < best) {
            best = sum;
            best_offset = offset;
          }
        }
      }
      ++votes[static_cast<std::size_t>(best_offset + 2)];
    }
  }
  EXPECT_GE(votes[2], 20);
  for (const std::size_t other : {0U, 1U, 3U, 4U}) EXPECT_GT(votes[2], 5 * votes[other]);
}

}  // namespace

}  // namespace plumbline
