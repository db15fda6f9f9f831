// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/line_visibility.h"

#include "worlds/path.h"
#include "worlds/scene.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;

Camera TestCamera(bool distorted = false) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 400;
  intrinsics.cx = 319.5;
  intrinsics.cy = 239.5;
  intrinsics.width = 640;
  intrinsics.height = 480;
  if (distorted) {
    intrinsics.model = DistortionModel::kRadTan;
    intrinsics.distortion = {-0.28, 0.07, 0.0002, 0.0001, 0};
  }
  return Camera(intrinsics);
}

// At the origin, turned to the left by `yaw`, looking along world x.
TimedView Level(double time = 0, double yaw = 0) {
  return {time, {CameraAttitude(yaw, 0, 0), Vector3d::Zero()}};
}

// Whether no rectangle stands in the way.
SightTest AroundRectangles(std::vector<Surface> rectangles) {
  return [rectangles](const Vector3d& from, const Vector3d& to, std::size_t) {
    for (const Surface& s : rectangles) {
      const Vector3d normal = s.Normal();
      const double t = normal.dot(s.origin - from) / normal.dot(to - from);
      if (!(t > 0 && t < 1)) continue;
      const Vector3d offset = from + t * (to - from) - s.origin;
      const double a = offset.dot(s.side_u) / s.side_u.squaredNorm();
      const double b = offset.dot(s.side_v) / s.side_v.squaredNorm();
      if (a >= 0 && a <= 1 && b >= 0 && b <= 1) return false;
    }
    return true;
  };
}

// Level line 4 m ahead from y = -1 (right) to y = 1 (left): 200 px.
const TrueLine kLine{{{4, -1, 0}, {4, 1, 0}}, TrueLineKind::kTexture};

TEST(LineVisibility, AFreeLineIsSeenWhole) {
  for (const bool distorted : {false, true}) {
    const std::vector views{Level()};
    const Camera camera = TestCamera(distorted);
    const SightTest sees = AroundRectangles({});
    const auto seen = LineVisibility(camera, views, sees).Trim(kLine);
    ASSERT_TRUE(seen);
    EXPECT_LT((seen->segment.start - kLine.segment.start).norm(), 1e-9);
    EXPECT_LT((seen->segment.end - kLine.segment.end).norm(), 1e-9);
    EXPECT_EQ(seen->kind, TrueLineKind::kTexture);
    EXPECT_THAT(*seen->visible, ElementsAre(FrameRange{0, 0}));
  }
}

TEST(LineVisibility, WhatAnOccluderHidesIsCutOff) {
  // A plate 2 m ahead that hides y < 0.1 there, that is y < 0.2 of the line.
  const std::vector views{Level()};
  const Camera camera = TestCamera();
  const SightTest sees = AroundRectangles({{{2, -2, -2}, {0, 2.1, 0}, {0, 0, 4}, {}}});
  const auto seen = LineVisibility(camera, views, sees).Trim(kLine);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->segment.start.y(), 0.2, 0.006);
  EXPECT_NEAR(seen->segment.end.y(), 1, 1e-9);
}

TEST(LineVisibility, WhatIsOutsideTheImageIsCutOff) {
  const std::vector views{Level()};
  const Camera camera = TestCamera(true);
  const SightTest sees = AroundRectangles({});
  const auto seen =
      LineVisibility(camera, views, sees).Trim({{{4, -40, 0}, {4, 40, 0}}, TrueLineKind::kTexture});
  ASSERT_TRUE(seen);
  const Rigid3 camera_from_world = Inverse(views[0].world_from_camera);
  const auto right = camera.Project(camera_from_world * seen->segment.start);
  const auto left = camera.Project(camera_from_world * seen->segment.end);
  ASSERT_TRUE(right && left);
  EXPECT_NEAR(right->x(), 639, 0.5);
  EXPECT_NEAR(left->x(), 0, 0.5);
}

TEST(LineVisibility, ShortPiecesDoNotCount) {
  // Bars 2 m ahead leave gaps of 0.1 m at the line's distance: 10 px. Where two bars are missing
  // there are 0.5 m: 50 px.
  std::vector<Surface> bars;
  for (int i = -10; i <= 10; ++i) {
    bars.push_back({{2, 0.1 * i, -1}, {0, 0.05, 0}, {0, 0, 2}, {}});
  }
  const std::vector views{Level()};
  const Camera camera = TestCamera();
  const SightTest all = AroundRectangles(bars);
  EXPECT_FALSE(LineVisibility(camera, views, all).Trim(kLine));
  EXPECT_TRUE(LineVisibility(camera, views, all, {.min_visible_px = 9}).Trim(kLine));
  EXPECT_FALSE(LineVisibility(camera, views, all, {.min_visible_px = 11}).Trim(kLine));
  bars.erase(bars.begin() + 10, bars.begin() + 12);  // at y = 0 and 0.1
  const SightTest some = AroundRectangles(bars);
  EXPECT_FALSE(LineVisibility(camera, views, some, {.min_visible_px = 51}).Trim(kLine));
  const auto seen = LineVisibility(camera, views, some, {.min_visible_px = 49}).Trim(kLine);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->segment.start.y(), -0.1, 0.006);
  EXPECT_NEAR(seen->segment.end.y(), 0.4, 0.006);
}

TEST(LineVisibility, LinesBehindTheCameraAreNotSeen) {
  const std::vector views{Level()};
  const Camera camera = TestCamera();
  const SightTest sees = AroundRectangles({});
  const LineVisibility visibility(camera, views, sees);
  EXPECT_FALSE(visibility.Trim({{{-4, -1, 0}, {-4, 1, 0}}, TrueLineKind::kTexture}));
  // From behind to before: the part before is seen as far as the image reaches.
  const auto seen = visibility.Trim({{{-4, 0.5, 0}, {4, 0.5, 0}}, TrueLineKind::kTexture});
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->segment.start.x(), 0.5 * 400 / 319.5, 0.01);
}

TEST(LineVisibility, MovingBodiesHideForAWhile) {
  std::vector<TimedView> views;
  for (int i = 0; i < 10; ++i) views.push_back(Level(i));
  const Camera camera = TestCamera();
  // A screen that stands before the whole line in frames 3 to 5 and before its left half from 6.
  const SightTest sees = [](const Vector3d&, const Vector3d& to, std::size_t frame) {
    return !(frame >= 3 && frame <= 5) && !(frame >= 6 && to.y() > 0);
  };
  const auto seen = LineVisibility(camera, views, sees).Trim(kLine);
  ASSERT_TRUE(seen);
  EXPECT_THAT(*seen->visible, ElementsAre(FrameRange{0, 2}, FrameRange{6, 9}));
  EXPECT_NEAR(seen->segment.Length(), 2, 1e-9);  // frames 0 to 2 saw it whole
}

TEST(LineVisibility, FramesAddUpToTheTrimmedLine) {
  // First only the right half is free, later only the left half.
  const std::vector views{Level(0), Level(1), Level(2)};
  const Camera camera = TestCamera();
  const SightTest sees = [](const Vector3d&, const Vector3d& to, std::size_t frame) {
    return frame == 0 ? to.y() < -0.3 : frame == 2 && to.y() > 0.2 && to.y() < 0.7;
  };
  const auto seen = LineVisibility(camera, views, sees).Trim(kLine);
  ASSERT_TRUE(seen);
  EXPECT_THAT(*seen->visible, ElementsAre(FrameRange{0, 0}, FrameRange{2, 2}));
  EXPECT_NEAR(seen->segment.start.y(), -1, 1e-9);
  EXPECT_NEAR(seen->segment.end.y(), 0.7, 0.006);
}

TEST(LineVisibility, LinesThatAreNotThereAreNotSeen) {
  const std::vector views{Level(0), Level(1), Level(2)};
  const Camera camera = TestCamera();
  const SightTest sees = AroundRectangles({});
  const LineVisibility visibility(camera, views, sees);
  const auto seen = visibility.Trim(kLine, {false, true, false});
  ASSERT_TRUE(seen);
  EXPECT_THAT(*seen->visible, ElementsAre(FrameRange{1, 1}));
  EXPECT_FALSE(visibility.Trim(kLine, {false, false, false}));
}

TEST(LineVisibility, TurningAwayLosesIt) {
  std::vector<TimedView> views;
  for (int i = 0; i < 9; ++i) views.push_back(Level(i, i * std::numbers::pi / 8));
  const Camera camera = TestCamera();
  const SightTest sees = AroundRectangles({});
  const auto seen = LineVisibility(camera, views, sees).Trim(kLine);
  ASSERT_TRUE(seen);
  // Half the view is 38.6 degrees, half the line 14: in part in view up to 52 degrees.
  EXPECT_THAT(*seen->visible, ElementsAre(FrameRange{0, 2}));
}

}  // namespace
}  // namespace plumbline
