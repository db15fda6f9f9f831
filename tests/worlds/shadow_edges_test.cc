// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/shadow_edges.h"

#include "worlds/scene_builder.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

// A floor of 4 x 4 m and a plate of 0.6 x 0.4 m over it, 1 m below a lamp that hangs 2 m high.
struct PlateOverFloor {
  double plate_height = 1;
  Eigen::Vector2d lamp_size = Eigen::Vector2d::Zero();

  Scene Make() const {
    SceneBuilder builder(1);
    builder.AddFloor({-2, -2, 0}, {4, 4}, Material::kBlank, 0.8);
    const Vector3d corner(-0.3, -0.2, plate_height);
    builder.AddPanel(corner, {0.6, 0, 0}, {0, 0.4, 0}, {Material::kBlank, 0.5});
    builder.AddLamp(
        {{0, 0, 2}, lamp_size.y() * Vector3d::UnitY(), lamp_size.x() * Vector3d::UnitX(), 2});
    return builder.Take();
  }
};

std::vector<ShadowEdge> Shadows(const Scene& scene, const ShadowLimits& limits = {}) {
  const RayTracer tracer(scene);
  return ShadowEdges(scene, scene.edges, tracer, limits, 1);
}

TEST(ShadowEdges, APlateThrowsItsOutline) {
  const auto shadows = Shadows(PlateOverFloor{}.Make());
  ASSERT_EQ(shadows.size(), 4U);
  // Seen from the lamp the plate is as far again from the floor: twice its size.
  for (const ShadowEdge& shadow : shadows) {
    const Vector3d middle = shadow.segment.Midpoint();
    EXPECT_NEAR(middle.z(), 0, 1e-9);
    const bool along_x = std::abs(shadow.segment.Direction().x()) > 0.5;
    EXPECT_NEAR(std::abs(along_x ? middle.y() : middle.x()), along_x ? 0.4 : 0.6, 1e-9);
    EXPECT_NEAR(shadow.segment.Length(), along_x ? 1.2 : 0.8, 0.03);
    EXPECT_EQ(shadow.circuit, 0);
  }
}

TEST(ShadowEdges, WidePenumbraeAreNone) {
  // A lamp of 5 x 5 cm: 5 cm of penumbra from a plate half way down, 2.5 cm from one at 2/3.
  EXPECT_TRUE(Shadows(PlateOverFloor{1, {0.05, 0.05}}.Make()).empty());
  EXPECT_EQ(Shadows(PlateOverFloor{2.0 / 3, {0.05, 0.05}}.Make()).size(), 4U);
  // A long tube is sharp across, but not along.
  const auto tube = Shadows(PlateOverFloor{1, {1.2, 0.01}}.Make());
  EXPECT_EQ(tube.size(), 2U);
  for (const ShadowEdge& shadow : tube) {
    EXPECT_GT(std::abs(shadow.segment.Direction().x()), 0.99);
  }
}

TEST(ShadowEdges, WeakLampsThrowNone) {
  Scene scene = PlateOverFloor{}.Make();
  for (const double x : {-1.5, 0.0, 1.5}) {  // three large lamps that wash the shadow out
    scene.lamps.push_back({{x, 1.7, 2}, 0.9 * Vector3d::UnitY(), 0.9 * Vector3d::UnitX(), 60});
  }
  EXPECT_TRUE(Shadows(scene).empty());
  scene = PlateOverFloor{}.Make();
  scene.lamps[0].power = 0.05;
  EXPECT_TRUE(Shadows(scene).empty());
}

TEST(ShadowEdges, WhatStandsInShadowThrowsNone) {
  Scene scene = PlateOverFloor{}.Make();
  SceneBuilder builder(2);
  builder.AddBox({{0, 0, 0}, {0.2, 0.2, 0.3}, 0}, Material::kBlank, 0.5);  // under the plate
  Scene box = builder.Take();
  scene.surfaces.insert(scene.surfaces.end(), box.surfaces.begin(), box.surfaces.end());
  scene.edges.insert(scene.edges.end(), box.edges.begin(), box.edges.end());
  EXPECT_EQ(Shadows(scene).size(), 4U);
}

TEST(ShadowEdges, StretchesThatFallOnSomethingElseAreLeftOut) {
  Scene scene = PlateOverFloor{}.Make();
  SceneBuilder builder(2);
  // A block on the border x = 0.6 of the shadow, which then lies on its top between y = -0.1, 0.1.
  builder.AddBox({{0.6, 0, 0}, {0.3, 0.2, 0.1}, 0}, Material::kBlank, 0.8);
  Scene box = builder.Take();
  scene.surfaces.insert(scene.surfaces.end(), box.surfaces.begin(), box.surfaces.end());
  double on_floor = 0, on_top = 0;
  for (const ShadowEdge& shadow : Shadows(scene)) {
    const Vector3d middle = shadow.segment.Midpoint();
    if (std::abs(middle.x() - 0.6) < 1e-6 && std::abs(middle.z()) < 1e-6) {
      on_floor += shadow.segment.Length();
    }
    if (std::abs(middle.z() - 0.1) < 1e-6 && std::abs(shadow.segment.Direction().y()) > 0.9) {
      EXPECT_NEAR(middle.x(), 0.57, 1e-6);
      on_top += shadow.segment.Length();
    }
  }
  EXPECT_NEAR(on_floor, 0.8 - 0.2, 0.05);
  EXPECT_NEAR(on_top, 0.2, 0.03);
}

TEST(ShadowEdges, KnowTheirCircuit) {
  Scene scene = PlateOverFloor{}.Make();
  scene.circuits.push_back({[](double) { return 1.0; }});
  scene.lamps[0].circuit = 1;
  const auto shadows = Shadows(scene);
  ASSERT_EQ(shadows.size(), 4U);
  for (const ShadowEdge& shadow : shadows) EXPECT_EQ(shadow.circuit, 1);
}

}  // namespace
}  // namespace plumbline
