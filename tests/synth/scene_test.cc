// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/scene.h"

#include "plumbline/synth/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

// Whether the segment is one of the four sides of the surface.
bool IsSideOf(const Segment3& segment, const Surface& surface) {
  const Vector3d corners[] = {
      surface.PointAt(0, 0), surface.PointAt(1, 0), surface.PointAt(1, 1), surface.PointAt(0, 1)};
  for (int i = 0; i < 4; ++i) {
    const Vector3d& a = corners[i];
    const Vector3d& b = corners[(i + 1) % 4];
    const double same = (segment.start - a).norm() + (segment.end - b).norm();
    const double reversed = (segment.start - b).norm() + (segment.end - a).norm();
    if (std::min(same, reversed) < 1e-9) return true;
  }
  return false;
}

double Distance(const Vector3d& point, const Surface& surface) {
  const Vector3d offset = point - surface.origin;
  const double a = std::clamp(offset.dot(surface.side_u) / surface.side_u.squaredNorm(), 0.0, 1.0);
  const double b = std::clamp(offset.dot(surface.side_v) / surface.side_v.squaredNorm(), 0.0, 1.0);
  return (point - surface.PointAt(a, b)).norm();
}

TEST(Scene, EveryEdgeIsWhereTwoFacesMeet) {
  const Scene scene = MakeRoom(3);
  ASSERT_GT(scene.edges.size(), 500U);
  for (const Segment3& edge : scene.edges) {
    const auto faces = std::count_if(scene.surfaces.begin(),
                                     scene.surfaces.end(),
                                     [&edge](const Surface& s) { return IsSideOf(edge, s); });
    EXPECT_GE(faces, 2) << edge.start.transpose() << " to " << edge.end.transpose();
  }
}

TEST(Scene, FacesOfABoxLookOutward) {
  SceneBuilder builder(1);
  const BoxShape box{{1, 2, 0.5}, {0.4, 0.6, 0.8}, 0.7};
  builder.AddBox(box, Material::kWood, 0.5);
  const Scene scene = builder.Take();
  ASSERT_EQ(scene.surfaces.size(), 6U);
  ASSERT_EQ(scene.edges.size(), 12U);
  const Vector3d centre = box.base + Vector3d(0, 0, 0.4);
  for (const Surface& surface : scene.surfaces) {
    EXPECT_NEAR(surface.side_u.dot(surface.side_v), 0, 1e-12);
    EXPECT_GT(surface.Normal().dot(surface.PointAt(0.5, 0.5) - centre), 0.19);
  }
}

TEST(Scene, WallsOfARoomLookInward) {
  SceneBuilder builder(1);
  builder.AddRoom({4, 3, 2}, Material::kPlaster, Material::kPlanks);
  for (const Surface& surface : builder.Take().surfaces) {
    EXPECT_GT(surface.Normal().dot(Vector3d(2, 1.5, 1) - surface.PointAt(0.5, 0.5)), 0.9);
  }
}

TEST(Scene, EverythingIsInsideTheRoom) {
  const Scene scene = MakeRoom(3);
  for (const Surface& surface : scene.surfaces) {
    for (int i = 0; i < 4; ++i) {
      const Vector3d corner = surface.PointAt(i % 2, i / 2);
      EXPECT_GE(corner.minCoeff(), -1e-9) << corner.transpose();
      EXPECT_LE((corner - RoomSize()).maxCoeff(), 1e-9) << corner.transpose();
    }
  }
}

HandHeldLoop RoomLoop(std::uint64_t seed) {
  return HandHeldLoop({{0.5 * RoomSize().x(), 0.5 * RoomSize().y(), 1.5}, 1.1, 0.75, 10, seed});
}

TEST(HandHeldLoop, KeepsAwayFromEverything) {
  const Scene scene = MakeRoom(1);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const HandHeldLoop loop = RoomLoop(seed);
    for (double time = 0; time < 10; time += 0.1) {
      const Vector3d position = loop.WorldFromCamera(time).translation;
      for (const Surface& surface : scene.surfaces) {
        ASSERT_GT(Distance(position, surface), 0.5) << time;
      }
    }
  }
}

TEST(HandHeldLoop, ClosesAndIsSmooth) {
  constexpr double kStep = 1e-3;
  const HandHeldLoop loop = RoomLoop(1);
  const Rigid3 begin = loop.WorldFromCamera(0), end = loop.WorldFromCamera(10);
  EXPECT_LT((begin.translation - end.translation).norm(), 1e-9);
  EXPECT_LT(AngularDistance(begin.rotation, end.rotation), 1e-9);
  double fastest = 0, quickest_turn = 0;
  Vector6d last = Vector6d::Zero();
  for (int i = 0; i < 10'000; ++i) {
    const Rigid3 a = loop.WorldFromCamera(i * kStep), b = loop.WorldFromCamera((i + 1) * kStep);
    const Vector6d velocity = LogSe3(Inverse(a) * b) / kStep;
    fastest = std::max(fastest, velocity.tail<3>().norm());
    quickest_turn = std::max(quickest_turn, velocity.head<3>().norm());
    if (i > 0) {
      ASSERT_LT((velocity - last).norm() / kStep, 20) << i;  // no jumps
    }
    last = velocity;
  }
  EXPECT_GT(fastest, 0.5);
  EXPECT_LT(fastest, 1.5);
  EXPECT_LT(quickest_turn, 0.5 * std::numbers::pi);
}

TEST(HandHeldLoop, HoldsTheCameraUpright) {
  const HandHeldLoop loop = RoomLoop(1);
  for (double time = 0; time < 10; time += 0.1) {
    const Eigen::Matrix3d axes = loop.WorldFromCamera(time).rotation.toRotationMatrix();
    EXPECT_NEAR(axes.determinant(), 1, 1e-12);
    EXPECT_LT(axes(2, 1), -0.85);          // y of the camera points down
    EXPECT_LT(std::abs(axes(2, 2)), 0.5);  // and its view is near level
  }
}

}  // namespace
}  // namespace plumbline
