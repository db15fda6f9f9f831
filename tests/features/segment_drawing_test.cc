// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/segment_drawing.h"

#include "tests/features/render.h"
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<Segment2> Draw(const GrayImage& image, double min_length = 15) {
  return DrawSegments(ComputeGradient(image, 1), min_length, 2);
}

// White noise on top.
GrayImage Noisy(GrayImage image, double sigma, std::uint64_t seed) {
  Rng rng(seed, "noise");
  for (int i = 0; i < image.width() * image.height(); ++i) {
    std::uint8_t& pixel = image.data()[i];
    const long level = std::lround(pixel + rng.Normal(sigma));
    pixel = static_cast<std::uint8_t>(std::clamp(level, 0L, 255L));
  }
  return image;
}

// Bright on the left of the line through `center` that runs at `angle`.
GrayImage Edge(const Eigen::Vector2d& center, double angle, double dark = 70, double bright = 180) {
  const Eigen::Vector2d left(std::sin(angle), -std::cos(angle));
  return Render(
      120, 120, [&](const Eigen::Vector2d& p) { return left.dot(p - center) > 0 ? bright : dark; });
}

TEST(DrawSegments, FindsOneEdgeAtEveryAngleBelowThePixel) {
  const Eigen::Vector2d center(60.25, 59.6);
  for (int degrees = -177; degrees < 180; degrees += 6) {
    const double angle = degrees * std::numbers::pi / 180;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const auto segments = Draw(Edge(center, angle));
    ASSERT_EQ(segments.size(), 1U) << degrees;
    EXPECT_GT(segments[0].Direction().dot(direction), 0.9999) << degrees;
    const Eigen::Vector3d line = LineThrough(segments[0]);
    EXPECT_NEAR(LineDistance(line, center), 0, 0.05) << degrees;
    EXPECT_GT(segments[0].Length(), 105) << degrees;
  }
}

TEST(DrawSegments, FindsAFaintEdgeUnderNoise) {
  const Eigen::Vector2d center(60.25, 59.6);
  int found = 0;
  for (int degrees = -170; degrees < 180; degrees += 20) {
    const double angle = degrees * std::numbers::pi / 180;
    const GrayImage image = Noisy(Edge(center, angle, 100, 130), 3, 5);
    for (const Segment2& s : Draw(image)) {
      if (s.Length() < 50) continue;
      EXPECT_NEAR(LineDistance(LineThrough(s), center), 0, 0.5) << degrees;
      ++found;
    }
  }
  EXPECT_GE(found, 16);
}

TEST(DrawSegments, DrawsBothEdgesOfABarInOppositeDirections) {
  const auto segments = Draw(Render(120, 120, [](const Eigen::Vector2d& p) {
    return std::abs(p.x() - 60.25) < 3 ? 200.0 : 90.0;
  }));
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_LT(segments[0].Direction().dot(segments[1].Direction()), -0.999);
  for (const Segment2& s : segments) {
    // The bright side, the inside, is on the left: negative.
    EXPECT_LT(LineDistance(LineThrough(s), {60.25, 60}), -2);
  }
}

TEST(DrawSegments, GoesOnBehindACrossingLine) {
  // A dark bar, four pixels wide, across an edge.
  const auto segments = Draw(Render(160, 120, [](const Eigen::Vector2d& p) {
    if (std::abs(p.x() - 80 - 0.2 * (p.y() - 60)) < 2) return 30.0;
    return p.y() > 60.25 ? 180.0 : 90.0;
  }));
  const auto flat = std::count_if(segments.begin(), segments.end(), [](const Segment2& s) {
    return std::abs(s.Direction().x()) > 0.99 && s.Length() > 140;
  });
  EXPECT_EQ(flat, 1);
  const auto steep = std::count_if(segments.begin(), segments.end(), [](const Segment2& s) {
    return std::abs(s.Direction().y()) > 0.95 && s.Length() > 40;
  });
  EXPECT_GE(steep, 2);
}

TEST(DrawSegments, DoesNotBridgeAWideGap) {
  const auto segments = Draw(Render(160, 120, [](const Eigen::Vector2d& p) {
    return p.y() > 60.25 && std::abs(p.x() - 80) > 15 ? 180.0 : 90.0;
  }));
  for (const Segment2& s : segments) {
    if (std::abs(s.Direction().x()) > 0.99) {
      EXPECT_LT(s.Length(), 70);
    }
  }
}

TEST(DrawSegments, DrawsTheFourSidesOfASquare) {
  const auto segments = Draw(Render(120, 120, [](const Eigen::Vector2d& p) {
    return std::max(std::abs(p.x() - 60.25), std::abs(p.y() - 60.25)) < 30 ? 180.0 : 90.0;
  }));
  ASSERT_EQ(segments.size(), 4U);
  for (const Segment2& s : segments) EXPECT_NEAR(s.Length(), 60, 6);
}

TEST(DrawSegments, FollowsACircleOnlyInShortPieces) {
  const Eigen::Vector2d center(60, 60);
  const auto segments = Draw(Render(
      120, 120, [&](const Eigen::Vector2d& p) { return (p - center).norm() < 40 ? 180.0 : 90.0; }));
  for (const Segment2& s : segments) {
    EXPECT_LT(s.Length(), 40);
    EXPECT_NEAR((s.Midpoint() - center).norm(), 40, 2);
  }
}

TEST(DrawSegments, FindsNothingInNoise) {
  for (const double sigma : {1.0, 4.0, 10.0, 25.0}) {
    const GrayImage image = Noisy(GrayImage(320, 240, 120), sigma, 11);
    EXPECT_LE(Draw(image, 22).size(), 1U) << sigma;
  }
}

TEST(DrawSegments, FindsNothingInFlatAndTinyImages) {
  EXPECT_TRUE(Draw(GrayImage(120, 120, 77)).empty());
  for (int width = 1; width <= 20; ++width) {
    for (int height = 1; height <= 20; ++height) {
      const GrayImage image = Render(
          width, height, [](const Eigen::Vector2d& p) { return p.x() > 4.3 ? 200.0 : 40.0; });
      EXPECT_TRUE(Draw(image, 21).empty()) << width << " x " << height;
      Draw(image, 1);
    }
  }
}

TEST(DrawSegments, StaysInsideTheImage) {
  for (const double x : {0.4, 1.4, 2.4, 3.4, 118.4, 117.4, 116.4, 115.4}) {
    for (const bool turned : {false, true}) {
      const auto segments = Draw(Render(120, 120, [&](const Eigen::Vector2d& p) {
        return (turned ? p.y() : p.x()) > x ? 200.0 : 40.0;
      }));
      for (const Segment2& s : segments) {
        for (const Eigen::Vector2d& end : {s.start, s.end}) {
          EXPECT_GE(end.minCoeff(), 0);
          EXPECT_LE(end.maxCoeff(), 119);
        }
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
