// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/patch_alignment.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Scene = std::function<double(const Eigen::Vector2d&)>;

constexpr int kSide = 100;
const Eigen::Vector2d kCentre(50, 50);

double Waves(const Eigen::Vector2d& p) {
  return 120 + 40 * std::sin(0.45 * p.x() + 0.2 * p.y()) +
         40 * std::cos(0.15 * p.x() - 0.5 * p.y());
}
double StraightEdge(const Eigen::Vector2d& p) {
  return 120 + 80 * std::tanh(0.5 * (p.x() - 50 + 0.3 * (p.y() - 50)));
}

GrayImage Picture(const Scene& scene) {
  GrayImage image(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      image.at(x, y) = static_cast<std::uint8_t>(std::lround(scene(Eigen::Vector2d(x, y))));
    }
  }
  return image;
}

// Where the later image shows what the reference shows at `from`, the detector having said `to`.
std::optional<Eigen::Vector2d> Align(const Scene& reference,
                                     const Eigen::Vector2d& from,
                                     const Scene& later,
                                     const Eigen::Vector2d& to,
                                     const Eigen::Matrix2d& linear = Eigen::Matrix2d::Identity(),
                                     int octave = 0,
                                     const PatchAlignmentOptions& options = {}) {
  PointFeature feature;
  feature.px = from;
  feature.octave = static_cast<std::int16_t>(octave);
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  return AlignPatches(Picture(reference),
                      {{feature}},
                      Picture(later),
                      TrackedPixels{to},
                      linear,
                      {&warp, 1},
                      options)
      .front();
}

TEST(AlignPatches, FindsTheShiftToAFractionOfAPixel) {
  const Eigen::Vector2d shift(2.3, -1.6);
  const Scene moved = [&](const Eigen::Vector2d& p) { return Waves(p - shift); };
  for (const Eigen::Vector2d& wrong : {Eigen::Vector2d(0.8, 0.5), Eigen::Vector2d(-0.6, 0.9)}) {
    const auto place = Align(Waves, kCentre, moved, kCentre + shift + wrong);
    ASSERT_TRUE(place);
    EXPECT_LT((*place - kCentre - shift).norm(), 0.05) << place->transpose();
  }
}

TEST(AlignPatches, FollowsTurnScaleBrightnessAndContrast) {
  const Eigen::Matrix2d linear = 1.15 * Eigen::Rotation2Dd(0.3).toRotationMatrix();
  const Eigen::Matrix2d inverse = linear.inverse();
  const Scene moved = [&](const Eigen::Vector2d& p) {
    return 20 + 0.7 * Waves(kCentre + inverse * (p - kCentre));
  };
  for (const int octave : {0, 3}) {
    const auto place =
        Align(Waves, kCentre, moved, kCentre + Eigen::Vector2d(0.7, -0.4), linear, octave);
    ASSERT_TRUE(place) << octave;
    EXPECT_LT((*place - kCentre).norm(), 0.05) << place->transpose();
  }
}

TEST(AlignPatches, TakesPatchesOfTheSizeOfTheirOctave) {
  const Scene moved = [](const Eigen::Vector2d& p) { return Waves(kCentre + 0.9 * (p - kCentre)); };
  const auto place = [&](int octave, double scale) {
    const Eigen::Matrix2d same = Eigen::Matrix2d::Identity();
    return Align(Waves, kCentre, moved, kCentre, same, octave, {.octave_scale = scale});
  };
  ASSERT_TRUE(place(2, 1.44));
  EXPECT_LT((*place(2, 1.44) - *place(4, 1.2)).norm(), 1e-9);
  EXPECT_GT((*place(2, 1.44) - *place(2, 1.2)).norm(), 1e-9);
}

// A surface may turn otherwise than the image as a whole. By shifts alone the place of a corner is
// half a pixel off, since parts of the patch on either side move apart.
TEST(AlignPatches, FollowsSurfacesThatTurnByThemselves) {
  const Scene corner = [](const Eigen::Vector2d& p) {
    const double inside = std::tanh(p.x() - 47) + std::tanh(p.y() - 47 - 0.2 * (p.x() - 47));
    return 120 + 30 * inside + 10 * std::sin(0.8 * p.x());
  };
  Eigen::Matrix2d turn;
  turn << 0.85, 0.04, -0.08, 1.06;
  const Scene turned = [&](const Eigen::Vector2d& p) {
    return corner(kCentre + turn.inverse() * (p - kCentre));
  };
  const auto error = [&](const PatchAlignmentOptions& options) {
    const Eigen::Vector2d guess = kCentre + Eigen::Vector2d(0.4, 0.3);
    const auto place =
        Align(corner, kCentre, turned, guess, Eigen::Matrix2d::Identity(), 0, options);
    return place ? (*place - kCentre).norm() : std::numeric_limits<double>::infinity();
  };
  EXPECT_LT(error({}), 0.12);
  EXPECT_GT(error({.warp_sigma = 1e-6}), 0.3);
}

// What turns far is followed through the images between, each search beginning where the last
// ended.
TEST(AlignPatches, GoesOnFromTheMapsOfTheFrameBefore) {
  const auto turned = [](double part) {
    Eigen::Matrix2d turn;
    turn << 1 - 0.5 * part, 0.1 * part, -0.3 * part, 1 + 0.3 * part;
    return [inverse = Eigen::Matrix2d(turn.inverse())](const Eigen::Vector2d& p) {
      return Waves(kCentre + inverse * (p - kCentre));
    };
  };
  PointFeature feature;
  feature.px = kCentre;
  const GrayImage reference = Picture(Waves);
  const auto align = [&](double part, Eigen::Matrix2d& warp) {
    return AlignPatches(reference,
                        {{feature}},
                        Picture(turned(part)),
                        TrackedPixels{kCentre},
                        Eigen::Matrix2d::Identity(),
                        {&warp, 1})
        .front();
  };
  Eigen::Matrix2d at_once = Eigen::Matrix2d::Identity();
  EXPECT_FALSE(align(1, at_once));
  EXPECT_EQ(at_once, Eigen::Matrix2d::Identity());
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  for (const double part : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    const auto place = align(part, warp);
    ASSERT_TRUE(place) << part;
    EXPECT_LT((*place - kCentre).norm(), 0.1) << part << ": " << place->transpose();
  }
  EXPECT_NEAR(warp(0, 0), 0.5, 0.05);
  EXPECT_NEAR(warp(1, 1), 1.3, 0.05);
}

TEST(AlignPatches, RejectsWhatSlidesAlongAnEdge) {
  EXPECT_FALSE(Align(StraightEdge, kCentre, StraightEdge, kCentre));
  // A corner on the same edge holds it.
  const Scene corner = [](const Eigen::Vector2d& p) { return p.y() > 50 ? StraightEdge(p) : 40.0; };
  EXPECT_TRUE(Align(corner, kCentre, corner, kCentre));
}

TEST(AlignPatches, RejectsWhatIsFarOffOrLooksDifferent) {
  EXPECT_FALSE(Align(Waves, kCentre, Waves, kCentre + Eigen::Vector2d(2.5, 0)));
  const Scene negative = [](const Eigen::Vector2d& p) { return 240 - Waves(p); };
  EXPECT_FALSE(Align(Waves, kCentre, negative, kCentre));
  const Scene blank = [](const Eigen::Vector2d&) { return 90.0; };
  EXPECT_FALSE(Align(Waves, kCentre, blank, kCentre));
  EXPECT_FALSE(Align(blank, kCentre, Waves, kCentre));
}

TEST(AlignPatches, RejectsPatchesThatLeaveAnImage) {
  const Eigen::Vector2d border(4, 50);
  EXPECT_FALSE(Align(Waves, border, Waves, border));
  const Scene moved = [](const Eigen::Vector2d& p) { return Waves(p + Eigen::Vector2d(46, 0)); };
  EXPECT_FALSE(Align(Waves, kCentre, moved, border));
}

}  // namespace
}  // namespace plumbline
