// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/true_lines.h"

#include "worlds/path.h"
#include "worlds/scene_builder.h"

#include <algorithm>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace true_lines_test {

using Eigen::Vector3d;
using testing::ElementsAre;

Camera TestCamera() {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 400;
  intrinsics.cx = 319.5;
  intrinsics.cy = 239.5;
  intrinsics.width = 640;
  intrinsics.height = 480;
  return Camera(intrinsics);
}

// Ten frames a second from one place.
std::vector<TimedView> StandStill(const Vector3d& place, double yaw, double pitch, int frames) {
  std::vector<TimedView> views;
  for (int i = 0; i < frames; ++i) {
    views.push_back({0.1 * i, {CameraAttitude(yaw, pitch, 0), place}});
  }
  return views;
}

std::vector<TrueLine> OfKind(const std::vector<TrueLine>& lines, TrueLineKind kind) {
  std::vector<TrueLine> some;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(some), [kind](const TrueLine& line) {
    return line.kind == kind;
  });
  return some;
}

// A plate between a lamp and the floor, seen from above at an angle.
SceneBuilder LampAndPlate(int circuit) {
  SceneBuilder builder(1);
  builder.AddFloor({-2, -2, 0}, {4, 4}, Material::kBlank, 0.8);
  builder.AddPanel({-0.3, -0.2, 1}, {0.6, 0, 0}, {0, 0.4, 0}, {Material::kBlank, 0.5});
  builder.AddLamp({{0, 0, 2}, Vector3d::Zero(), Vector3d::Zero(), 2, circuit});
  return builder;
}

TEST(TrueLines, ShadowsAreSeenWhileTheirLampIsOn) {
  SceneBuilder builder = LampAndPlate(1);
  builder.AddCircuit([](double time) { return time > 0.25 && time < 0.65 ? 1.0 : 0.0; });
  const auto views = StandStill({-2, 0, 1.6}, 0, 0.6, 10);
  const auto lines = TrueLines(builder.Take(), TestCamera(), views, {}, 1);
  const auto shadows = OfKind(lines, TrueLineKind::kShadow);
  ASSERT_EQ(shadows.size(), 4U);
  for (const TrueLine& line : shadows) EXPECT_THAT(*line.visible, ElementsAre(FrameRange{3, 6}));
  for (const TrueLine& line : OfKind(lines, TrueLineKind::kGeometry)) {
    EXPECT_THAT(*line.visible, ElementsAre(FrameRange{0, 9}));
  }
}

TEST(TrueLines, MovingBodiesThrowNoTrueLinesButHideThem) {
  SceneBuilder builder = LampAndPlate(0);
  // A wall that stands before the camera from t = 0.45 on.
  builder.BeginBody([](double time) {
    return Rigid3{Eigen::Quaterniond::Identity(), {-1.6, 0, time > 0.45 ? 0.0 : 50.0}};
  });
  builder.AddBox({{0, 0, 0}, {0.05, 4, 3}, 0}, Material::kBrick, 0.5);
  builder.EndBody();
  const auto views = StandStill({-2, 0, 1.6}, 0, 0.6, 10);
  const auto lines = TrueLines(builder.Take(), TestCamera(), views, {}, 1);
  EXPECT_EQ(OfKind(lines, TrueLineKind::kShadow).size(), 4U);
  EXPECT_TRUE(OfKind(lines, TrueLineKind::kTexture).empty());  // the bricks move
  ASSERT_FALSE(lines.empty());
  for (const TrueLine& line : lines) {
    EXPECT_THAT(*line.visible, ElementsAre(FrameRange{0, 4}));
  }
}

TEST(TrueLines, PaintedEdgesRunOnOverThePiecesOfAWall) {
  // A wall of form-board concrete with a window: the joint at 1.2 m runs below the window.
  SceneBuilder builder(1);
  const Opening window{1, 1, 1.5, 0.8};
  builder.AddWall(
      {{-2, 3, 0}, {2, 3, 0}, 2.6, 0.2}, std::span(&window, 1), Material::kConcrete, 0.6);
  const auto views = StandStill({0, 0, 1.4}, 0.5 * std::numbers::pi, 0, 1);
  const auto lines = TrueLines(builder.Take(), TestCamera(), views, {}, 1);
  int sides = 0;
  for (const TrueLine& line : OfKind(lines, TrueLineKind::kTexture)) {
    if (std::abs(line.segment.start.z() - 1.2) > 0.007) continue;
    ++sides;
    EXPECT_NEAR(line.segment.Length(), 4, 0.02);
    EXPECT_NEAR(line.segment.start.y(), 2.9, 1e-9);
  }
  EXPECT_EQ(sides, 2);
}

TEST(TrueLines, EdgesThatLieOnEachOtherCountOnce) {
  // Two boxes side by side and a third on top: edges in common.
  SceneBuilder builder(1);
  builder.AddBox({{3, 0.25, 0}, {0.5, 0.5, 0.5}, 0}, Material::kBlank, 0.5);
  builder.AddBox({{3, -0.25, 0}, {0.5, 0.5, 0.5}, 0}, Material::kBlank, 0.3);
  builder.AddBox({{3, 0, 0.5}, {0.5, 1, 0.5}, 0}, Material::kBlank, 0.7);
  const auto views = StandStill({0, 0, 1.8}, 0, 0.4, 1);
  const auto lines = TrueLines(builder.Take(), TestCamera(), views, {}, 1);
  // Level: three at the front and one at the back, 1 m. Upright: the outer two, 1 m in one piece,
  // and half of that between the lower boxes. Those that run away from the camera are too short.
  std::vector<double> lengths;
  for (const TrueLine& line : lines) lengths.push_back(line.segment.Length());
  std::sort(lengths.begin(), lengths.end());
  EXPECT_THAT(lengths,
              testing::Pointwise(testing::DoubleNear(0.011), {0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0}));
}

TEST(TrueLines, AreNoneWhereNothingIsSeen) {
  SceneBuilder builder = LampAndPlate(0);
  const Scene scene = builder.Take();
  EXPECT_TRUE(TrueLines(scene, TestCamera(), StandStill({-2, 0, 1.6}, 0, -1.2, 3), {}, 1).empty());
  EXPECT_TRUE(TrueLines(scene, TestCamera(), {}, {}, 1).empty());
  EXPECT_TRUE(TrueLines(Scene{}, TestCamera(), StandStill({-2, 0, 1.6}, 0, 0.6, 3), {}, 1).empty());
}

}  // namespace true_lines_test
}  // namespace plumbline
