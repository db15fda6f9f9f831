// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/features/match_points.h"

#include "tests/features/render.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace stereo_windows_test {

using testing::HasSubstr;

constexpr int kWidth = 240;
constexpr int kHeight = 100;

// Waves of 6 to 30 px in all directions, so that all places tell how far they were moved.
class WaveTexture {
 public:
  WaveTexture() {
    Rng rng(3, "wave texture");
    for (Wave& wave : waves_) {
      const double frequency = 2 * std::numbers::pi / rng.Uniform(6, 30);
      const double angle = rng.Uniform(0, 2 * std::numbers::pi);
      wave.frequency = frequency * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      wave.phase = rng.Uniform(0, 2 * std::numbers::pi);
    }
  }

  double operator()(const Eigen::Vector2d& p) const {
    double level = 128;
    for (const Wave& wave : waves_) level += 15 * std::sin(wave.frequency.dot(p) + wave.phase);
    return level;
  }

 private:
  struct Wave {
    Eigen::Vector2d frequency;
    double phase = 0;
  };
  std::array<Wave, 8> waves_;
};

// What a camera sees that is moved by `shift`, in one level.
ImagePyramid Shifted(double shift) {
  const WaveTexture texture;
  return BuildPyramid(
      Render(kWidth,
             kHeight,
             [&](const Eigen::Vector2d& p) { return texture(p + Eigen::Vector2d(shift, 0)); }),
      1,
      1.2);
}

// Every tenth pixel with room for the largest window and shift.
std::vector<PointFeature> Points() {
  std::vector<PointFeature> points;
  for (int y = 20; y < kHeight - 20; y += 10) {
    for (int x = 60; x < kWidth - 20; x += 10) {
      PointFeature point;
      point.px = {x, y};
      points.push_back(point);
    }
  }
  return points;
}

std::vector<std::optional<Disparity>> Match(const ImagePyramid& left,
                                            const ImagePyramid& right,
                                            int window_px,
                                            double baseline = 0.1) {
  RectifiedCamera camera = TestCamera(kWidth, kHeight);
  camera.baseline = baseline;
  const ValidRegion valid(kWidth, kHeight);
  return MatchStereoPoints(camera, Points(), {left, right, valid}, {.window_px = window_px});
}

TEST(StereoPoints, MeasureWithWindowsOfAllSizesOnASingleLevel) {
  const ImagePyramid left = Shifted(0);
  for (const double shift : {3.0, 12.4, 25.75}) {
    const ImagePyramid right = Shifted(shift);
    for (const int window_px : {2, 3, 4, 7, 8, 15}) {
      for (const std::optional<Disparity>& d : Match(left, right, window_px)) {
        ASSERT_TRUE(d) << shift << ' ' << window_px;
        ASSERT_NEAR(d->px, shift, 0.2) << window_px;
      }
    }
  }
}

TEST(StereoPoints, SayWhatTheyCannotWorkWith) {
  const ImagePyramid one = Shifted(0);
  const GrayImage& image = one.front().image;
  const auto error = [](const auto& match) -> std::string {
    try {
      match();
    } catch (const BugError& bug) {
      return bug.what();
    }
    return "no error";
  };
  const auto two = BuildPyramid(image, 2, 1.2);
  EXPECT_THAT(error([&] { Match(one, one, 16); }), HasSubstr("size of the correlation window"));
  EXPECT_THAT(error([&] { Match(one, one, -1); }), HasSubstr("size of the correlation window"));
  EXPECT_THAT(error([&] { Match(one, two, 5); }), HasSubstr("pyramids of one kind"));
  EXPECT_THAT(error([&] { Match(one, one, 5, 0); }), HasSubstr("stereo needs a baseline"));
  EXPECT_EQ(error([&] { Match(one, one, 15); }), "no error");
}

}  // namespace stereo_windows_test
}  // namespace plumbline
