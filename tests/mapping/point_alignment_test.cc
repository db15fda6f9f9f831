// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/point_alignment.h"

#include "plumbline/base/random.h"
#include "plumbline/features/orb.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace point_alignment_test {

// A painted wall at a depth of 8 m before the first camera, which drives towards it.
constexpr double kDepth = 8;
const std::vector<Eigen::Vector2d> kPlaces = {{0.31, 0.22}, {-1.1, 0.6}, {0.7, -0.9}, {-0.4, -0.5}};

RectifiedCamera OneCamera() {
  RectifiedCamera camera;
  camera.fx = camera.fy = 300;
  camera.cx = 200;
  camera.cy = 150;
  camera.width = 400;
  camera.height = 300;
  return camera;
}

double Paint(const Eigen::Vector2d& wall) {
  return 120 + 40 * std::sin(22 * wall.x() + 10 * wall.y()) +
         40 * std::cos(8 * wall.x() - 24 * wall.y());
}

// Seen from `forward` metres nearer.
Eigen::Vector2d PixelOf(const Eigen::Vector2d& wall, double forward) {
  return OneCamera().Project({wall.x(), wall.y(), kDepth - forward});
}
Eigen::Vector2d WallAt(const Eigen::Vector2d& px, double forward) {
  return OneCamera().Unproject(px).head<2>() * (kDepth - forward);
}

GrayImage View(double forward, double contrast = 1) {
  GrayImage image(400, 300);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double grey = Paint(WallAt(Eigen::Vector2d(x, y), forward));
      image.at(x, y) = static_cast<std::uint8_t>(std::lround(128 + contrast * (grey - 128)));
    }
  }
  return image;
}

ImagePyramid PyramidOf(const GrayImage& image) {
  return BuildOrbPyramid(image, {.scale_factor = 1.2});
}

// A map of the places, each keyframe with corners that are off by `errors` from where it shows
// them, and in the octave that their size asks for.
struct WallMap {
  Map map;

  KeyFrameId Add(double forward, const Eigen::Vector2d& error, int octave) {
    const KeyFrameId id = map.NextKeyFrameId();
    Features features;
    for (const Eigen::Vector2d& place : kPlaces) {
      PointFeature corner;
      corner.px = PixelOf(place, forward) + error;
      corner.octave = static_cast<std::int16_t>(octave);
      features.points.push_back(corner);
    }
    features.point_disparity.resize(kPlaces.size());
    Frame frame{FrameId{id.value}, id.value, {}, IndexFeatures(OneCamera(), features), {}, {}};
    frame.cam_from_world.translation.z() = -forward;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      const auto value = static_cast<std::int64_t>(i);
      frame.points.push_back(id.value == 0 ? PointId{} : PointId{value});
    }
    map.Apply({edit::AddKeyFrame{{id, KeyFrameId{id.value - 1}, frame}}});
    if (id.value > 0) return id;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      MapPoint point;
      point.id = PointId{static_cast<std::int64_t>(i)};
      point.position = {kPlaces[i].x(), kPlaces[i].y(), kDepth};
      point.created_by = id;
      point.observations = {{id, static_cast<int>(i)}};
      map.Apply({edit::AddPoint{point}});
    }
    return id;
  }
};

double LargestError(const Features& features, const Eigen::Vector2d& first_error, double forward) {
  double largest = 0;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const Eigen::Vector2d shown = WallAt(PixelOf(kPlaces[i], 0) + first_error, 0);
    largest = std::max(largest, (features.points[i].px - PixelOf(shown, forward)).norm());
  }
  return largest;
}

TEST(PointAligner, LaterCornersShowWhatTheFirstOnesShow) {
  const Eigen::Vector2d first(0.3, -0.2);
  WallMap wall;
  PointAligner aligner(OneCamera(), 1.2);
  EXPECT_EQ(aligner.Align(wall.map, wall.Add(0, first, 0), PyramidOf(View(0))), nullptr);
  // Nearer, larger, darker; corners are found in the octave of their size, and off by its pixels.
  for (const auto& [forward, octave] : {std::pair{1.3, 1}, std::pair{3.0, 3}, std::pair{4.6, 5}}) {
    const KeyFrameId id = wall.Add(forward, {-0.7, 0.9}, octave);
    const auto aligned = aligner.Align(wall.map, id, PyramidOf(View(forward, 0.8)));
    ASSERT_NE(aligned, nullptr);
    EXPECT_GT(LargestError(wall.map.Find(id)->frame.features(), first, forward), 1);
    EXPECT_LT(LargestError(aligned->features, first, forward), 0.15) << forward;
    EXPECT_EQ(aligned->features.points[0].octave, octave);
  }
  EXPECT_EQ(aligner.recent().size(), 4U);
}

// What the corner says counts as far as noise makes the place of the patch uncertain.
TEST(PointAligner, NoiseLeavesMoreToTheCorner) {
  std::vector<double> moved;
  for (const double noise : {0.0, 25.0}) {
    WallMap wall;
    PointAligner aligner(OneCamera(), 1.2);
    aligner.Align(wall.map, wall.Add(0, {0, 0}, 0), PyramidOf(View(0)));
    const KeyFrameId id = wall.Add(1, {0.8, 0}, 1);
    GrayImage image = View(1);
    Rng rng(7);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const double grey = image.at(x, y) + rng.Normal(noise);
        image.at(x, y) = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
      }
    }
    const auto aligned = aligner.Align(wall.map, id, PyramidOf(image));
    ASSERT_NE(aligned, nullptr);
    double sum = 0;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      sum +=
          wall.map.Find(id)->frame.features().points[i].px.x() - aligned->features.points[i].px.x();
    }
    moved.push_back(sum / static_cast<double>(kPlaces.size()));
  }
  EXPECT_NEAR(moved[0], 0.8, 0.1);
  EXPECT_LT(moved[1], 0.9 * moved[0]);
  EXPECT_GT(moved[1], 0.2 * moved[0]);
}

TEST(PointAligner, LeavesWhatDoesNotLookAlike) {
  WallMap wall;
  PointAligner aligner(OneCamera(), 1.2);
  aligner.Align(wall.map, wall.Add(0, {0, 0}, 0), PyramidOf(View(0)));
  EXPECT_EQ(aligner.Align(wall.map, wall.Add(2, {0.5, 0}, 2), PyramidOf(View(2, -0.9))), nullptr);
  EXPECT_EQ(aligner.Align(wall.map, wall.Add(2, {0.5, 0}, 2), PyramidOf(GrayImage(400, 300, 90))),
            nullptr);
}

TEST(PointAligner, ForgetsTheOldest) {
  WallMap wall;
  PointAligner aligner(OneCamera(), 1.2);
  const GrayImage image = View(0);
  for (std::size_t i = 0; i < PointAligner::kRecent + 3; ++i) {
    aligner.Align(wall.map, wall.Add(0, {0, 0}, 0), PyramidOf(image));
  }
  EXPECT_EQ(aligner.recent().size(), PointAligner::kRecent);
  EXPECT_EQ(aligner.recent().front().keyframe, KeyFrameId{3});
}

}  // namespace point_alignment_test
}  // namespace plumbline
