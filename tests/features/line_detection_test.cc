// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/line_detection.h"

#include "tests/features/render.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kEdgeX = 151.25;  // between the samples of Render

// Bright right of the line through (kEdgeX, 120), which leans by `tilt` (dx per dy).
GrayImage EdgeImage(double tilt, double dark = 60, double bright = 160) {
  return Render(320, 240, [=](const Eigen::Vector2d& p) {
    return p.x() > kEdgeX + tilt * (p.y() - 120) ? bright : dark;
  });
}

std::vector<LineFeature> Detect(const GrayImage& image,
                                LineDetector detector = LineDetector::kDrawing,
                                int count = 200,
                                const LineDetectionOptions& options = {}) {
  return DetectLines(image,
                     ComputeGradient(image, kLineBlurPx),
                     ValidRegion(image.width(), image.height()),
                     detector,
                     count,
                     options);
}

std::vector<LineFeature> DetectInside(const GrayImage& image, const GrayImage& mask) {
  return DetectLines(image,
                     ComputeGradient(image, kLineBlurPx),
                     ValidRegion(mask),
                     LineDetector::kDrawing,
                     200,
                     {});
}

class LineDetectors : public testing::TestWithParam<LineDetector> {};
INSTANTIATE_TEST_SUITE_P(Each,
                         LineDetectors,
                         testing::Values(LineDetector::kDrawing,
                                         LineDetector::kLsd,
                                         LineDetector::kEdlines));

TEST_P(LineDetectors, PlaceAnEdgeWithinATenthOfAPixel) {
  for (const double tilt : {0.0, 0.3, -0.8}) {
    const auto lines = Detect(EdgeImage(tilt), GetParam());
    ASSERT_EQ(lines.size(), 1U) << tilt;
    for (const Eigen::Vector2d& end : {lines[0].segment.start, lines[0].segment.end}) {
      const double error = (end.x() - kEdgeX - tilt * (end.y() - 120)) / std::hypot(1, tilt);
      EXPECT_NEAR(error, 0, 0.1) << tilt;
    }
    EXPECT_GT(lines[0].segment.Length(), 180);
    EXPECT_GT(lines[0].response, 10);
  }
}

TEST_P(LineDetectors, PlaceAnEdgeAtHalfSizeToo) {
  LineDetectionOptions options;
  options.detection_scale = 0.5;
  for (const double tilt : {0.0, 0.3, -0.8}) {
    const auto lines = Detect(EdgeImage(tilt), GetParam(), 200, options);
    ASSERT_EQ(lines.size(), 1U) << tilt;
    for (const Eigen::Vector2d& end : {lines[0].segment.start, lines[0].segment.end}) {
      const double error = (end.x() - kEdgeX - tilt * (end.y() - 120)) / std::hypot(1, tilt);
      EXPECT_NEAR(error, 0, 0.1) << tilt;
    }
    EXPECT_GT(lines[0].segment.Length(), 180);
  }
}

TEST_P(LineDetectors, FindNothingInFlatAndTinyImages) {
  EXPECT_TRUE(Detect(GrayImage(320, 240, 90), GetParam()).empty());
  for (int size = 1; size <= 20; ++size) {
    EXPECT_TRUE(Detect(GrayImage(size, 21 - size, 90), GetParam()).empty()) << size;
    LineDetectionOptions half;
    half.detection_scale = 0.5;
    EXPECT_TRUE(Detect(GrayImage(size, 20, 90), GetParam(), 200, half).empty()) << size;
  }
}

TEST_P(LineDetectors, GiveTheSameEveryTime) {
  const GrayImage image = Render(320, 240, SquareTexture(60, 320, 240));
  const auto a = Detect(image, GetParam());
  const auto b = Detect(image, GetParam());
  EXPECT_GT(a.size(), 5U);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].segment.start, b[i].segment.start);
    EXPECT_EQ(a[i].segment.end, b[i].segment.end);
  }
}

TEST(LineDetection, DirectsLinesWithTheBrightSideOnTheLeft) {
  // Seen with y down, the bright right half lies on the left of a line that runs down.
  const auto down = Detect(EdgeImage(0));
  ASSERT_EQ(down.size(), 1U);
  EXPECT_GT(down[0].segment.Direction().y(), 0.99);
  EXPECT_LT(LineDistance(LineThrough(down[0].segment), {300, 120}), 0);
  // With the contrast turned round the same edge runs up.
  const auto up = Detect(EdgeImage(0, 160, 60));
  ASSERT_EQ(up.size(), 1U);
  EXPECT_LT(up[0].segment.Direction().y(), -0.99);
}

TEST(LineDetection, JoinsPiecesOverASmallGapOnly) {
  const auto with_gap = [](double gap) {
    return Render(320, 240, [=](const Eigen::Vector2d& p) {
      // A dark bar lies across the edge.
      if (std::abs(p.y() - 120) < 0.5 * gap) return 60.0;
      return p.x() > 150.3 ? 160.0 : 60.0;
    });
  };
  const auto vertical = [](const std::vector<LineFeature>& lines) {
    return std::count_if(lines.begin(), lines.end(), [](const LineFeature& l) {
      return std::abs(l.segment.Direction().y()) > 0.9;
    });
  };
  EXPECT_EQ(vertical(Detect(with_gap(2))), 1);
  EXPECT_EQ(vertical(Detect(with_gap(20))), 2);
}

TEST(LineDetection, DropsTheEdgeOfTheMaskAndCutsLinesThere) {
  const GrayImage image = EdgeImage(0);
  GrayImage mask(320, 240, 255);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 320; ++x) mask.at(x, y) = 0;
  }
  const auto cut = DetectInside(image, mask);
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_GE(std::min(cut[0].segment.start.y(), cut[0].segment.end.y()), 62);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 152; ++x) mask.at(x, y) = 0;
  }
  EXPECT_TRUE(DetectInside(image, mask).empty());
}

TEST(LineDetection, KeepsNoMoreThanAskedAndFromAllOverTheImage) {
  const GrayImage image = Render(640, 480, SquareTexture(500, 640, 480));
  LineDetectionOptions options;
  options.min_length = 0.02;
  const auto all = Detect(image, LineDetector::kDrawing, 1000, options);
  const auto few = Detect(image, LineDetector::kDrawing, 40, options);
  ASSERT_GT(all.size(), 80U);
  EXPECT_EQ(few.size(), 40U);
  for (const bool right : {false, true}) {
    for (const bool low : {false, true}) {
      const auto quarter = std::count_if(few.begin(), few.end(), [&](const LineFeature& l) {
        return (l.segment.Midpoint().x() > 320) == right && (l.segment.Midpoint().y() > 240) == low;
      });
      EXPECT_GE(quarter, 4);
    }
  }
}

}  // namespace
}  // namespace plumbline
