// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/scene_builder.h"

#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace scene_builder_test {

using Eigen::Vector3d;

const Vector3d kRoomSize(6.4, 5.2, 2.8);

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

TEST(Scene, EveryEdgeIsWhereTwoFacesMeet) {
  const Scene scene = MakeRoom(3).scene;
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
  const Scene scene = MakeRoom(3).scene;
  for (const Surface& surface : scene.surfaces) {
    for (int i = 0; i < 4; ++i) {
      const Vector3d corner = surface.PointAt(i % 2, i / 2);
      EXPECT_GE(corner.minCoeff(), -1e-9) << corner.transpose();
      EXPECT_LE((corner - kRoomSize).maxCoeff(), 1e-9) << corner.transpose();
    }
  }
}

TEST(SceneBuilder, AWallHasHolesAndOneTexture) {
  SceneBuilder builder(1);
  const Opening holes[] = {{0.5, 0.9, 0, 2}, {2, 1, 0.8, 1.2}};
  builder.AddWall({{1, 1, 0}, {5, 1, 0}, 2.6, 0.2}, holes, Material::kPlaster, 0.6);
  const Scene scene = builder.Take();
  const Vector3d through_wall[] = {{3.5, 1, 0.4}, {1.2, 1, 1}, {2, 1, 2.3}};
  const Vector3d through_hole[] = {{1.9, 1, 1}, {3.5, 1, 1.5}};
  const auto faces_at = [&](const Vector3d& middle) {
    int count = 0;
    for (const Surface& surface : scene.surfaces) {
      for (const double side : {-0.1, 0.1}) {
        count += surface.DistanceTo(middle + side * Vector3d::UnitY()) < 1e-9 ? 1 : 0;
      }
    }
    return count;
  };
  for (const Vector3d& place : through_wall) EXPECT_EQ(faces_at(place), 2) << place.transpose();
  for (const Vector3d& place : through_hole) EXPECT_EQ(faces_at(place), 0) << place.transpose();
  // Pieces of a face that touch agree in what their texture shows at the seam.
  const Surface *below = nullptr, *left = nullptr;
  for (const Surface& surface : scene.surfaces) {
    if (surface.DistanceTo({3.05, 0.9, 0.4}) < 1e-9) below = &surface;
    if (surface.DistanceTo({2.95, 0.9, 0.4}) < 1e-9) left = &surface;
  }
  ASSERT_TRUE(below != nullptr && left != nullptr && below != left);
  const auto value = [](const Surface& surface, const Vector3d& point) {
    const Vector3d offset = point - surface.origin;
    return EvaluateTexture(surface.texture,
                           offset.dot(surface.side_u.normalized()),
                           offset.dot(surface.side_v.normalized()),
                           surface.side_u.norm(),
                           surface.side_v.norm());
  };
  EXPECT_NEAR(value(*below, {3, 0.9, 0.4}), value(*left, {3, 0.9, 0.4}), 1e-9);
}

TEST(SceneBuilder, FacesOfAWallLookOutward) {
  SceneBuilder builder(1);
  const Opening holes[] = {{1, 1, 0.5, 1}};
  builder.AddWall({{0, 0, 0}, {0, 3, 0}, 2, 0.4}, holes, Material::kPlaster, 0.6);
  // From anywhere in the solid, all faces that can be reached look away.
  const Scene scene = builder.Take();
  const Vector3d solid[] = {{0, 0.5, 1}, {0, 2.5, 1}, {0, 1.5, 1.8}, {0, 1.5, 0.2}};
  for (const Surface& surface : scene.surfaces) {
    const Vector3d middle = surface.PointAt(0.5, 0.5);
    double nearest = 1e9;
    Vector3d from = Vector3d::Zero();
    for (const Vector3d& point : solid) {
      if ((point - middle).norm() < nearest) {
        nearest = (point - middle).norm();
        from = point;
      }
    }
    EXPECT_GT(surface.Normal().dot(middle - from), 0) << middle.transpose();
  }
}

TEST(SceneBuilder, ABodyHasItsOwnFrameAndNoStillEdges) {
  SceneBuilder builder(1);
  builder.AddBox({}, Material::kWood, 0.5);
  builder.BeginBody([](double time) {
    return Rigid3{Eigen::Quaterniond::Identity(), {time, 0, 0}};
  });
  builder.AddBox({}, Material::kWood, 0.5);
  builder.EndBody();
  builder.AddBox({{3, 0, 0}, {1, 1, 1}, 0}, Material::kWood, 0.5);
  const Scene scene = builder.Take();
  EXPECT_EQ(scene.edges.size(), 24U);
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_EQ(scene.bodies[0].world_from_body(2).translation.x(), 2);
  EXPECT_EQ(std::count_if(scene.surfaces.begin(),
                          scene.surfaces.end(),
                          [](const Surface& s) { return s.body == 0; }),
            6);
}

}  // namespace scene_builder_test
}  // namespace plumbline
