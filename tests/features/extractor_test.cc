// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/extractor.h"

#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/rectify.h"

#include "tests/features/render.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace plumbline {
namespace extractor_test {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kShift = 12.4;

struct Pair {
  GrayImage left;
  GrayImage right;
};

Pair ShiftedPair() {
  const SquareTexture texture(80, kWidth, kHeight);
  return {Render(kWidth, kHeight, texture), Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
            return texture(p + Eigen::Vector2d(kShift, 0));
          })};
}

void ExpectSame(const Features& a, const Features& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].px, b.points[i].px);
    EXPECT_EQ(a.points[i].descriptor, b.points[i].descriptor);
    ASSERT_EQ(a.point_disparity[i].has_value(), b.point_disparity[i].has_value());
    if (a.point_disparity[i]) {
      EXPECT_EQ(a.point_disparity[i]->px, b.point_disparity[i]->px);
    }
  }
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].segment.start, b.lines[i].segment.start);
    EXPECT_EQ(a.lines[i].descriptor, b.lines[i].descriptor);
    EXPECT_EQ(a.line_right[i].has_value(), b.line_right[i].has_value());
  }
}

// All that two steps measure in a frame.
Features ExtractAll(const RectifiedCamera& camera,
                    const FeatureInput& input,
                    const FeatureOptions& options) {
  Features features = ExtractFeatures(camera, input, options);
  for (const auto& right : features.line_right) EXPECT_FALSE(right);
  features.line_right = FindRightLines(camera, input, options, features.lines);
  return features;
}

TEST(ExtractFeatures, MeasuresPointsAndLinesOfAStereoPair) {
  const Pair pair = ShiftedPair();
  const Features f = ExtractAll(TestCamera(kWidth, kHeight), {&pair.left, &pair.right}, {});
  EXPECT_EQ(f.points.size(), f.point_disparity.size());
  EXPECT_EQ(f.lines.size(), f.line_right.size());
  int with_depth = 0;
  int right = 0;
  for (std::size_t i = 0; i < f.lines.size(); ++i) {
    if (!f.line_right[i]) continue;
    const auto d = LineEndDisparities(f.lines[i], *f.line_right[i]);
    if (!d) continue;
    ++with_depth;
    right += std::abs(0.5 * (d->start.px + d->end.px) - kShift) < 0.2 ? 1 : 0;
  }
  EXPECT_GT(with_depth, 15);
  EXPECT_GE(right, with_depth * 9 / 10);
}

TEST(ExtractFeatures, GivesTheSameInOneThreadAndInTwo) {
  const Pair pair = ShiftedPair();
  FeatureOptions options;
  options.parallel = true;
  const Features a = ExtractAll(TestCamera(kWidth, kHeight), {&pair.left, &pair.right}, options);
  options.parallel = false;
  ExpectSame(a, ExtractAll(TestCamera(kWidth, kHeight), {&pair.left, &pair.right}, options));
}

TEST(ExtractFeatures, LeavesOutWhatIsSwitchedOff) {
  const Pair pair = ShiftedPair();
  FeatureOptions options;
  options.lines = false;
  Features f = ExtractAll(TestCamera(kWidth, kHeight), {&pair.left, &pair.right}, options);
  EXPECT_GT(f.points.size(), 50U);
  EXPECT_TRUE(f.lines.empty());
  EXPECT_TRUE(f.line_right.empty());
  options.lines = true;
  options.points = false;
  f = ExtractAll(TestCamera(kWidth, kHeight), {&pair.left, &pair.right}, options);
  EXPECT_TRUE(f.points.empty());
  EXPECT_GT(f.lines.size(), 20U);
}

TEST(ExtractFeatures, WorksOnASingleImageAndWithDepth) {
  const Pair pair = ShiftedPair();
  RectifiedCamera camera = TestCamera(kWidth, kHeight);
  const DepthImage depth(kWidth, kHeight, 2);
  const Features rgbd = ExtractAll(camera, {.left = &pair.left, .depth = &depth}, {});
  ASSERT_FALSE(rgbd.points.empty());
  for (const std::optional<Disparity>& d : rgbd.point_disparity) {
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->px, 15, 1e-6);
  }
  ASSERT_FALSE(rgbd.lines.empty());
  for (std::size_t i = 0; i < rgbd.lines.size(); ++i) {
    ASSERT_TRUE(rgbd.line_right[i]);
    const Eigen::Vector2d& left = rgbd.lines[i].segment.start;
    EXPECT_NEAR((left - rgbd.line_right[i]->segment.start).x(), 15, 1e-4);
  }
  camera.baseline = 0;
  const Features mono = ExtractAll(camera, {.left = &pair.left}, {});
  EXPECT_EQ(mono.points.size(), rgbd.points.size());
  ASSERT_EQ(mono.point_disparity.size(), mono.points.size());
  for (const std::optional<Disparity>& d : mono.point_disparity) EXPECT_FALSE(d);
  for (const std::optional<MeasuredSegment>& right : mono.line_right) EXPECT_FALSE(right);
}

TEST(ExtractFeatures, SurvivesFlatAndTinyImagesAndRefusesWrongSizes) {
  for (const auto& [width, height] : {std::pair{320, 240}, {20, 16}, {3, 2}, {1, 1}}) {
    const GrayImage flat(width, height, 90);
    const Features f = ExtractAll(TestCamera(width, height), {&flat, &flat}, {});
    EXPECT_TRUE(f.points.empty() && f.lines.empty()) << width;
  }
  const GrayImage image(320, 240, 90);
  EXPECT_THROW(ExtractFeatures(TestCamera(320, 241), {&image}, {}), BugError);
  EXPECT_THROW(ExtractFeatures(TestCamera(320, 240), {}, {}), BugError);
  EXPECT_THROW(FindRightLines(TestCamera(320, 241), {&image, &image}, {}, {}), BugError);
}

TEST(ExtractFeatures, FindsDepthInARealStereoPair) {
  const auto folder = FindData("euroc/MH_01_easy_first250/mav0");
  if (!folder) GTEST_SKIP() << "no EuRoC data";
  const auto load = [&](const char* camera) {
    const auto path = *folder / camera / "data" / "1403636584763555584.webp";
    return ToImage<std::uint8_t>(cv::imread(path.string(), cv::IMREAD_GRAYSCALE));
  };
  SensorFrame frame;
  frame.left = load("cam0");
  frame.right = load("cam1");
  const Rectifier rectifier(EurocCalibration());
  const RectifiedFrame rectified = rectifier.Apply(std::move(frame));
  const ValidRegion left(rectifier.left_mask());
  const ValidRegion right(rectifier.right_mask());
  const FeatureInput input{&rectified.left, &*rectified.right, nullptr, &left, &right};
  const Features f = ExtractAll(rectifier.camera(), input, {});
  const auto given = [](const auto& values) {
    return std::count_if(values.begin(), values.end(), [](const auto& v) { return v.has_value(); });
  };
  EXPECT_GT(f.points.size(), 950U);
  EXPECT_LE(f.points.size(), 1000U);
  EXPECT_GT(given(f.point_disparity), 350);
  EXPECT_GT(f.lines.size(), 130U);
  EXPECT_GT(given(f.line_right), 80);
}

}  // namespace extractor_test
}  // namespace plumbline
