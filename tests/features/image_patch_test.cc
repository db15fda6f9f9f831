// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/image_patch.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <cstdint>
#include <functional>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {
namespace image_patch_test {

using Scene = std::function<double(const Eigen::Vector2d&)>;
constexpr int kRadius = 5;

double Waves(const Eigen::Vector2d& p) {
  return 120 + 40 * std::sin(0.45 * p.x() + 0.2 * p.y()) +
         40 * std::cos(0.15 * p.x() - 0.5 * p.y());
}

GrayImage Picture(const Scene& scene) {
  GrayImage image(100, 100);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y) = static_cast<std::uint8_t>(std::lround(scene(Eigen::Vector2d(x, y))));
    }
  }
  return image;
}

std::optional<ImagePatch> PatchAt(const GrayImage& image, const Eigen::Vector2d& px) {
  const auto wide = SamplePatch(image, px, Eigen::Matrix2d::Identity(), kRadius + 1);
  return wide ? MakePatch(*wide, kRadius) : std::nullopt;
}

TEST(SamplePatch, InterpolatesAlongItsAxes) {
  const GrayImage slope = Picture([](const Eigen::Vector2d& p) { return 2 * p.x() + p.y(); });
  const Eigen::Matrix2d axes = (Eigen::Matrix2d() << 0.5, 0, 0, 1).finished();
  const auto samples = SamplePatch(slope, {40.25, 30.5}, axes, 1);
  ASSERT_TRUE(samples.has_value());
  ASSERT_EQ(samples->size(), 9);
  for (int v = -1; v <= 1; ++v) {
    for (int u = -1; u <= 1; ++u) {
      EXPECT_NEAR((*samples)(3 * (v + 1) + u + 1), 2 * (40.25 + 0.5 * u) + 30.5 + v, 1e-9);
    }
  }
  EXPECT_FALSE(SamplePatch(slope, {0.4, 30}, axes, 1).has_value());
  EXPECT_FALSE(SamplePatch(slope, {40, 98.5}, axes, 1).has_value());
}

TEST(MakePatch, NeedsSomethingToSee) {
  EXPECT_FALSE(PatchAt(Picture([](const auto&) { return 90; }), {50, 50}).has_value());
  const auto waves = PatchAt(Picture(Waves), {50, 50});
  ASSERT_TRUE(waves.has_value());
  EXPECT_NEAR(waves->samples.matrix().norm(), 1, 1e-12);
  EXPECT_NEAR(waves->samples.sum(), 0, 1e-12);
  EXPECT_TRUE(waves->IsRound(0.15));
  const Scene edge = [](const Eigen::Vector2d& p) { return 120 + 80 * std::tanh(p.x() - 50); };
  EXPECT_FALSE(PatchAt(Picture(edge), {50, 50})->IsRound(0.15));
}

TEST(AlignShift, FindsThePlaceWhateverTheBrightness) {
  const auto patch = PatchAt(Picture(Waves), {50, 50});
  ASSERT_TRUE(patch.has_value());
  const Eigen::Vector2d shift(2.3, -1.6);
  const GrayImage darker =
      Picture([&](const Eigen::Vector2d& p) { return 20 + 0.7 * Waves(p - shift); });
  const Eigen::Vector2d truth = Eigen::Vector2d(50, 50) + shift;
  const Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
  const auto found = AlignShift(*patch, darker, truth + Eigen::Vector2d(0.8, 0.5), axes, {});
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->px - truth).norm(), 0.03);
  // Too far, and something else.
  EXPECT_FALSE(
      AlignShift(*patch, darker, truth + Eigen::Vector2d(0.8, 0.5), axes, {.max_shift_px = 0.5}));
  const GrayImage other = Picture([](const Eigen::Vector2d& p) { return 255 - Waves(p); });
  EXPECT_FALSE(AlignShift(*patch, other, {50, 50}, axes, {}));
}

// Noise in the image moves the place as the covariance says: the mean of chi2 with two degrees of
// freedom is 2. The place is a whole pixel, since interpolation between pixels blurs noise, and
// makes that of neighbours alike, which the covariance does not know.
TEST(AlignShift, KnowsHowFarNoiseMovesIt) {
  const auto patch = PatchAt(Picture(Waves), {50, 50});
  ASSERT_TRUE(patch.has_value());
  const Eigen::Vector2d shift(1, -1);
  double sum = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    Rng rng(static_cast<std::uint64_t>(run));
    const GrayImage noisy =
        Picture([&](const Eigen::Vector2d& p) { return Waves(p - shift) + rng.Normal(6); });
    const auto found = AlignShift(*patch, noisy, {51.2, 49.5}, Eigen::Matrix2d::Identity(), {});
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((found->shift - (found->px - Eigen::Vector2d(51.2, 49.5))).norm(), 1e-12);
    const Eigen::Vector2d error = found->px - Eigen::Vector2d(50, 50) - shift;
    sum += error.dot(found->covariance.inverse() * error);
  }
  EXPECT_GT(sum / kRuns, 1);
  EXPECT_LT(sum / kRuns, 4);
}

}  // namespace image_patch_test
}  // namespace plumbline
