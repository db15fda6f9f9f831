// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/orb.h"

#include "plumbline/base/statistics.h"

#include "tests/features/render.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<PointFeature> Orb(const GrayImage& image, int count, const OrbOptions& options = {}) {
  return ExtractOrb(
      BuildOrbPyramid(image, options), ValidRegion(image.width(), image.height()), count, options);
}

const PointFeature* Nearest(const std::vector<PointFeature>& points,
                            const Eigen::Vector2d& px,
                            int octave) {
  const PointFeature* best = nullptr;
  for (const PointFeature& p : points) {
    if (p.octave != octave) continue;
    if (!best || (p.px - px).norm() < (best->px - px).norm()) best = &p;
  }
  return best;
}

TEST(Orb, FindsNothingInFlatAndTinyImages) {
  EXPECT_TRUE(Orb(GrayImage(320, 240, 90), 500).empty());
  EXPECT_TRUE(Orb(GrayImage(8, 5, 90), 500).empty());
  EXPECT_TRUE(Orb(GrayImage(39, 39, 90), 500).empty());
}

TEST(Orb, GivesNoMoreThanAskedAndTheSameEveryTime) {
  const GrayImage image = Render(320, 240, SquareTexture(150, 320, 240));
  const std::vector<PointFeature> a = Orb(image, 200);
  const std::vector<PointFeature> b = Orb(image, 200);
  ASSERT_LE(a.size(), 200U);
  EXPECT_GT(a.size(), 150U);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].px, b[i].px);
    EXPECT_EQ(a[i].descriptor, b[i].descriptor);
  }
  EXPECT_TRUE(Orb(image, 0).empty());
}

double ScaleOf(const PointFeature& point, const OrbOptions& options) {
  return std::pow(options.scale_factor, point.octave);
}

// Two noisy images of one texture, whose right half has a fifth of the contrast: the deviations say
// how much more the corners there move, and none is said to be better than it is.
TEST(Orb, DeviationFollowsTheContrast) {
  const SquareTexture texture(150, 320, 240);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 2);
  const auto image = [&] {
    return Render(320, 240, [&](const Eigen::Vector2d& p) {
      return 128 + (p.x() < 160 ? 1 : 0.2) * (texture(p) - 128) + noise(random);
    });
  };
  const auto a = Orb(image(), 400);
  const auto b = Orb(image(), 400);
  std::vector<double> sigma[2], moved[2];  // strong, weak; level pixels, and deviations
  for (const PointFeature& p : a) {
    const PointFeature* other = Nearest(b, p.px, p.octave);
    if (!other || (other->px - p.px).norm() > 2 * ScaleOf(p, {})) continue;
    const std::size_t side = p.px.x() < 160 ? 0 : 1;
    sigma[side].push_back(p.sigma_px / ScaleOf(p, {}));
    moved[side].push_back((other->px - p.px).norm() / std::hypot(p.sigma_px, other->sigma_px));
  }
  ASSERT_GT(moved[0].size(), 50U);
  ASSERT_GT(moved[1].size(), 50U);
  EXPECT_GT(UpperMedian(std::span<double>(sigma[1])),
            1.2 * UpperMedian(std::span<double>(sigma[0])));
  EXPECT_LT(UpperMedian(std::span<double>(moved[0])), 1.18);  // of two components of one deviation
  EXPECT_LT(UpperMedian(std::span<double>(moved[1])), 1.18);
  for (const PointFeature& p : a) EXPECT_GE(p.sigma_px, kCornerSigmaPx * ScaleOf(p, {}));
}

TEST(Orb, FollowsASubPixelShift) {
  const SquareTexture texture(150, 320, 240);
  const Eigen::Vector2d shift(1.4, -0.7);
  const OrbOptions options;
  const auto a = Orb(Render(320, 240, texture), 300);
  const auto b =
      Orb(Render(320, 240, [&](const Eigen::Vector2d& p) { return texture(p - shift); }), 300);
  std::vector<double> errors;  // level pixels
  int alike = 0;
  for (const PointFeature& p : a) {
    const PointFeature* other = Nearest(b, p.px + shift, p.octave);
    if (!other) continue;
    const double error = (other->px - p.px - shift).norm() / ScaleOf(p, options);
    if (error > 2) continue;
    errors.push_back(error);
    alike += HammingDistance(p.descriptor, other->descriptor) < 60 ? 1 : 0;
  }
  ASSERT_GT(errors.size(), a.size() / 2);
  EXPECT_GT(alike, 0.85 * static_cast<double>(errors.size()));
  const auto middle = errors.begin() + static_cast<long>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  EXPECT_LT(*middle, 0.25);  // whole pixels would give about 0.5
}

TEST(Orb, GivesNoPointTwice) {
  const auto points = Orb(Render(320, 240, SquareTexture(150, 320, 240)), 500);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(points[i].octave == points[j].octave &&
                   (points[i].px - points[j].px).norm() < 0.9);
    }
  }
}

TEST(Orb, TurnsWithTheImage) {
  const SquareTexture texture(150, 320, 320);
  const auto a = Orb(Render(320, 320, texture), 300);
  // Turned by 90 degrees about the centre: q = (319 - p.y, p.x).
  const auto b = Orb(Render(320,
                            320,
                            [&](const Eigen::Vector2d& q) {
                              return texture({q.y(), 319 - q.x()});
                            }),
                     300);
  int compared = 0;
  int alike = 0;
  int turned_alike = 0;
  for (const PointFeature& p : a) {
    const Eigen::Vector2d turned(319 - p.px.y(), p.px.x());
    const PointFeature* other = Nearest(b, turned, p.octave);
    if (!other || (other->px - turned).norm() > 0.3) continue;
    ++compared;
    const double turn =
        std::remainder(other->angle - p.angle - 0.5 * std::numbers::pi, 2 * std::numbers::pi);
    turned_alike += std::abs(turn) < 0.1 ? 1 : 0;
    alike += HammingDistance(p.descriptor, other->descriptor) < 60 ? 1 : 0;
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(alike, compared * 9 / 10);
  EXPECT_GT(turned_alike, compared * 9 / 10);
}

TEST(Orb, KeepsItsPatchOnValidPixels) {
  const GrayImage image = Render(320, 240, SquareTexture(150, 320, 240));
  GrayImage mask(320, 240, 255);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 120; ++x) mask.at(x, y) = 0;
  }
  const OrbOptions options;
  const auto points = ExtractOrb(BuildOrbPyramid(image, options), ValidRegion(mask), 300, options);
  EXPECT_GT(points.size(), 50U);
  for (const PointFeature& p : points) {
    EXPECT_GT(p.px.x(), 119 + 17 * ScaleOf(p, options));
  }
}

TEST(Orb, SpreadsPointsOverATextureThatIsStrongInOnePlace) {
  const SquareTexture texture(150, 320, 240);
  // The right half has a fifth of the contrast.
  const GrayImage image = Render(320, 240, [&](const Eigen::Vector2d& p) {
    return p.x() < 160 ? texture(p) : 128 + 0.2 * (texture(p) - 128);
  });
  const auto points = Orb(image, 150);
  const auto right = std::count_if(
      points.begin(), points.end(), [](const PointFeature& p) { return p.px.x() > 165; });
  EXPECT_GT(right, 40);
}

// The image that corners were found in gives their descriptors again, except where rounding takes
// another pixel; another image does not.
TEST(Orb, DescribesCornersAgain) {
  const SquareTexture texture(150, 320, 240);
  const GrayImage image = Render(320, 240, texture);
  const std::vector<PointFeature> points = Orb(image, 300);
  ASSERT_GT(points.size(), 100U);
  EXPECT_GT(points.back().octave, 2);
  const auto bits_in = [&](const GrayImage& other) {
    std::vector<double> bits;
    const auto described = DescribeOrbAt(BuildOrbPyramid(other, {}), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      bits.push_back(HammingDistance(described.at(i).value(), points[i].descriptor));
    }
    return bits;
  };
  const std::vector<double> same = bits_in(image);
  EXPECT_GT(std::count(same.begin(), same.end(), 0.0), 0.98 * static_cast<double>(same.size()));
  const GrayImage moved = Render(
      320, 240, [&](const Eigen::Vector2d& p) { return texture(p + Eigen::Vector2d(40, 0)); });
  EXPECT_GT(UpperMedian(bits_in(moved)), 100);
}

TEST(Orb, DescribesNoCornerBeyondTheImage) {
  const ImagePyramid pyramid = BuildOrbPyramid(GrayImage(320, 240, 90), {});
  PointFeature point;
  point.px = {18, 221};
  EXPECT_TRUE(DescribeOrbAt(pyramid, {point})[0]);
  for (const Eigen::Vector2d& px :
       {Eigen::Vector2d(17, 100), Eigen::Vector2d(100, 222), Eigen::Vector2d(1e300, -1e300)}) {
    point.px = px;
    EXPECT_FALSE(DescribeOrbAt(pyramid, {point})[0]) << px.transpose();
  }
  point.px = {160, 120};
  point.octave = 60;
  EXPECT_FALSE(DescribeOrbAt(pyramid, {point})[0]);
}

}  // namespace
}  // namespace plumbline
