// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/parallel.h"
#include "plumbline/features/match_points.h"
#include "plumbline/features/orb.h"

#include "tests/features/render.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace stereo_points_test {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Side {
  ImagePyramid pyramid;
  std::vector<PointFeature> points;
};

Side Extract(const GrayImage& image) {
  Side side;
  side.pyramid = BuildOrbPyramid(image, {});
  side.points = ExtractOrb(side.pyramid, ValidRegion(kWidth, kHeight), 400, {});
  return side;
}

std::vector<std::optional<Disparity>> Match(const Side& left,
                                            const Side& right,
                                            const StereoPointOptions& options = {}) {
  return MatchStereoPoints(TestCamera(kWidth, kHeight),
                           left.points,
                           {left.pyramid, right.pyramid, ValidRegion(kWidth, kHeight)},
                           options);
}

TEST(StereoPoints, MeasureAKnownShiftBelowThePixel) {
  const SquareTexture texture(150, kWidth, kHeight);
  const Side left = Extract(Render(kWidth, kHeight, texture));
  for (const double shift : {3.0, 12.4, 25.75}) {
    // The right image is darker too: cameras differ.
    const Side right = Extract(Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
      return texture(p + Eigen::Vector2d(shift, 0)) - 10;
    }));
    int found = 0;
    int within_sigma = 0;
    double squares = 0;
    for (const std::optional<Disparity>& d : Match(left, right)) {
      if (!d) continue;
      ++found;
      within_sigma += std::abs(d->px - shift) < 2.5 * d->sigma_px ? 1 : 0;
      squares += std::min(1.0, std::pow(d->px - shift, 2));
    }
    EXPECT_GT(found, 150) << shift;
    EXPECT_LT(std::sqrt(squares / found), 0.25) << shift;
    EXPECT_GT(within_sigma, 0.85 * found) << shift;
  }
}

TEST(StereoPoints, AreNotFoundInTheInventedBorderOfTheRightImage) {
  const SquareTexture texture(150, kWidth, kHeight);
  const Side left = Extract(Render(kWidth, kHeight, texture));
  const Side right = Extract(Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
    return texture(p + Eigen::Vector2d(10, 0));
  }));
  constexpr int kBorder = kWidth / 2;
  GrayImage mask(kWidth, kHeight, 255);
  for (int y = 0; y < kHeight; ++y) std::fill_n(mask.row(y), kBorder, std::uint8_t{0});
  HelperThread helper;
  const auto disparities = MatchStereoPoints(TestCamera(kWidth, kHeight),
                                             left.points,
                                             {left.pyramid, right.pyramid, ValidRegion(mask)},
                                             {},
                                             &helper);
  int found = 0;
  for (std::size_t i = 0; i < disparities.size(); ++i) {
    if (!disparities[i]) continue;
    ++found;
    EXPECT_GT(left.points[i].px.x() - disparities[i]->px, kBorder + 5);
  }
  EXPECT_GT(found, 60);
}

TEST(StereoPoints, AreNotFoundOutsideTheRangeOfDisparities) {
  const SquareTexture texture(150, kWidth, kHeight);
  const Side left = Extract(Render(kWidth, kHeight, texture));
  const auto shifted = [&](double shift) {
    return Extract(Render(kWidth, kHeight, [&](const Eigen::Vector2d& p) {
      return texture(p + Eigen::Vector2d(shift, 0));
    }));
  };
  StereoPointOptions options;
  options.min_depth_m = 2;  // fx b / z = 15 px
  const auto count = [&](const Side& right) {
    int found = 0;
    for (const std::optional<Disparity>& d : Match(left, right, options)) {
      if (!d) continue;
      EXPECT_GT(d->px, 0);
      EXPECT_LE(d->px, 15);
      ++found;
    }
    return found;
  };
  EXPECT_GT(count(shifted(10)), 150);
  EXPECT_LT(count(shifted(25)), 15);
  EXPECT_LT(count(shifted(-8)), 15);  // behind the camera
}

TEST(StereoPoints, OfEmptyViewsAreEmpty) {
  const Side flat = Extract(GrayImage(kWidth, kHeight, 90));
  EXPECT_TRUE(Match(flat, flat).empty());
  const Side left = Extract(Render(kWidth, kHeight, SquareTexture(150, kWidth, kHeight)));
  for (const std::optional<Disparity>& d : Match(left, flat)) EXPECT_FALSE(d);
}

}  // namespace stereo_points_test
}  // namespace plumbline
