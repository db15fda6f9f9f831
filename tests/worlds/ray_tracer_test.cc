// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/ray_tracer.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace ray_tracer_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr unsigned kNothing = RayTracer::kNothing;

// A square of 2 m around the z axis at a height.
Surface SquareAt(double z, std::optional<int> body = std::nullopt) {
  Surface surface;
  surface.origin = {-1, -1, z};
  surface.side_u = {2, 0, 0};
  surface.side_v = {0, 2, 0};
  surface.body = body;
  return surface;
}

// What a ray meets first at a time in seconds.
unsigned FirstOf(const Scene& scene, const Vector3f& from, const Vector3f& to, double time = 0) {
  const RayTracer tracer(scene);
  RayTracer::Rays rays;
  rays.origin = from;
  rays.count = 3;
  rays.directions.fill(to - from);
  unsigned hits[RayTracer::kPacket];
  tracer.Trace(rays, tracer.At(time), hits);
  EXPECT_EQ(hits[0], hits[2]) << "rays of one packet";
  return hits[0];
}

TEST(RayTracer, FindsTheNearestSurface) {
  Scene scene;
  scene.surfaces = {SquareAt(3), SquareAt(1), SquareAt(2)};
  EXPECT_EQ(FirstOf(scene, {0, 0, 0}, {0.1F, 0.2F, 1}), 1U);
  EXPECT_EQ(FirstOf(scene, {0, 0, 5}, {0.1F, 0.2F, 1}), 0U);
  EXPECT_EQ(FirstOf(scene, {0, 0, 1.5F}, {0.1F, 0.2F, 2}), 2U);
  EXPECT_EQ(FirstOf(scene, {0, 0, 0}, {0, 0, -1}), kNothing);
  EXPECT_EQ(FirstOf(scene, {0, 0, 0}, {3, 0, 1}), kNothing) << "beside them";
}

// Rays that are rounded in many ways: what they find must not depend on it.
TEST(RayTracer, OfSurfacesAtOnePlaceFindsTheOneOfTheSmallestIndex) {
  Scene scene;
  for (int i = 0; i < 40; ++i) scene.surfaces.push_back(SquareAt(1.37));
  scene.surfaces.push_back(SquareAt(1.3699999));
  for (int i = 0; i < 100; ++i) {
    const auto angle = static_cast<float>(0.37 * i);
    const Vector3f from(0.3F * std::cos(angle), 0.3F * std::sin(angle), -0.013F * angle);
    const Vector3f to(0.2F * std::sin(3 * angle), 0.1F * std::cos(5 * angle), 1.37F);
    EXPECT_EQ(FirstOf(scene, from, to), 40U) << "a ten-millionth of a metre nearer";
    EXPECT_EQ(FirstOf(scene, {from.x(), from.y(), 9}, to), 0U) << "from behind";
  }
}

// Points of light maps lie on walls, and some of these in corners.
TEST(RayTracer, FindsWhatARayBeginsOn) {
  Scene scene;
  scene.surfaces = {SquareAt(4), SquareAt(1.1), SquareAt(2)};
  for (int i = 0; i < 100; ++i) {
    const auto angle = static_cast<float>(0.37 * i);
    const Vector3f from(0.9F * std::cos(angle), 0.7F * std::sin(angle), 1.1F);
    const Vector3f direction(0.1F * std::sin(3 * angle), 0.1F, 0.8F);
    const unsigned first = FirstOf(scene, from, from + direction);
    EXPECT_TRUE(first == 1 || first == 2) << first << ", the surface itself or the next one";
    EXPECT_EQ(FirstOf(scene, from - 1e-6F * direction, from + direction), 1U);
    EXPECT_EQ(FirstOf(scene, from + 1e-6F * direction, from + direction), 2U);
  }
}

TEST(RayTracer, FindsBodiesWhereTheyAre) {
  Scene scene;
  scene.surfaces = {SquareAt(5), SquareAt(0, 0), SquareAt(0, 1)};
  scene.bodies = {{[](double time) {
                    return Rigid3{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d::UnitZ())),
                                  {10 * time, 0, 2}};
                  }},
                  {[](double) {
                    return Rigid3{Eigen::Quaterniond::Identity(), {0, 0, 3}};
                  }}};
  EXPECT_EQ(FirstOf(scene, {0, 0, 0}, {0.1F, 0.1F, 1}), 1U);
  EXPECT_EQ(FirstOf(scene, {0, 0, 0}, {0.1F, 0.1F, 1}, 1), 2U) << "the first one has gone";
  EXPECT_EQ(FirstOf(scene, {0, 0, 2.5F}, {0, 0, 1}), 1U) << "from above";
  EXPECT_EQ(FirstOf(scene, {0, 0, 4}, {0.01F, 0, 6}), 0U) << "which stands still";
}

TEST(RayTracer, SeesWhatNothingIsBefore) {
  Scene scene;
  scene.surfaces = {SquareAt(1), SquareAt(0, 0)};
  scene.bodies = {{[](double time) {
    return Rigid3{Eigen::Quaterniond::Identity(), {0, 10 * time, 3}};
  }}};
  const RayTracer tracer(scene);
  const Vector3f low(0, 0, 0), on(0.2F, 0, 1), middle(0.1F, 0.3F, 2), high(0.3F, 0.1F, 4);
  EXPECT_FALSE(tracer.StillSees(low, middle, 0.001F));
  EXPECT_TRUE(tracer.StillSees(low, on, 0.001F)) << "with a margin, what it ends on";
  EXPECT_FALSE(tracer.StillSees(low, on, 0));
  EXPECT_TRUE(tracer.StillSees(middle, high, 0.001F));
  EXPECT_FALSE(tracer.BodiesLetPass(middle, high, 0.001F, tracer.At(0)));
  EXPECT_TRUE(tracer.BodiesLetPass(middle, high, 0.001F, tracer.At(1)));
  EXPECT_TRUE(tracer.BodiesLetPass(low, middle, 0.001F, tracer.At(0)));
}

}  // namespace
}  // namespace ray_tracer_test
}  // namespace plumbline
