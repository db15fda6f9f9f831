// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/se3.h"
#include "worlds/ray_tracer.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kBaseline = 0.11;

World Make(const char* name, std::uint64_t seed = 1) { return FindWorld(name).make(seed); }

// Directions over the whole view of the camera, the bent corners of a real lens included.
std::vector<Vector3d> ViewRays() {
  constexpr int kColumns = 24, kRows = 16;
  constexpr double kWide = 1.15, kHigh = 0.8;
  std::vector<Vector3d> rays;
  for (int i = 0; i < kColumns * kRows; ++i) {
    rays.emplace_back(kWide * (2.0 * (i % kColumns) / (kColumns - 1) - 1),
                      kHigh * (2.0 * (i / kColumns) / (kRows - 1) - 1),
                      1);
  }
  return rays;
}

// What the camera sees at a time: a surface for each ray of the view, or RayTracer::kNothing.
std::vector<unsigned> Seen(const RayTracer& tracer, const World& world, double time) {
  const Rigid3 pose = world.path.world_from_camera(time);
  const RayTracer::Moment moment = tracer.At(time);
  std::vector<unsigned> seen;
  for (const Vector3d& ray : ViewRays()) {
    RayTracer::Rays rays;
    rays.origin = pose.translation.cast<float>();
    rays.directions.fill((pose.rotation * ray).cast<float>());
    rays.count = 1;
    unsigned hits[RayTracer::kPacket] = {};
    tracer.Trace(rays, moment, hits);
    seen.push_back(hits[0]);
  }
  return seen;
}

Vector3d Velocity(const CameraPath& path, double time) {
  constexpr double kStep = 0.05;
  return (path.world_from_camera(time + kStep).translation -
          path.world_from_camera(time - kStep).translation) /
         (2 * kStep);
}

TEST(Planar, OnePlaneFillsTheView) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = Make("planar", seed);
    const Surface& first = world.scene.surfaces.front();
    for (const Surface& surface : world.scene.surfaces) {
      EXPECT_LT(first.Normal().cross(surface.Normal()).norm(), 1e-12);
      EXPECT_NEAR(first.Normal().dot(surface.origin - first.origin), 0, 1e-12);
    }
    const RayTracer tracer(world.scene);
    for (double time = 0; time < world.path.duration; time += 0.5) {
      for (const unsigned hit : Seen(tracer, world, time)) ASSERT_NE(hit, RayTracer::kNothing);
    }
  }
}

TEST(Forward, MovesAlongTheViewAxis) {
  const World world = Make("forward");
  double moving = 0;
  for (double time = 0; time < world.path.duration; time += 0.1) {
    const Vector3d velocity = Velocity(world.path, time);
    if (velocity.norm() < 0.2) continue;
    ++moving;
    const Vector3d ahead = world.path.world_from_camera(time).rotation * Vector3d::UnitZ();
    EXPECT_GT(ahead.dot(velocity.normalized()), std::cos(0.1)) << time;
  }
  EXPECT_GT(0.1 * moving, 0.9 * world.path.duration);
}

TEST(Lateral, MovesAcrossTheViewAxisThereAndBack) {
  const World world = Make("lateral");
  double right = 0, left = 0;
  for (double time = 0; time < world.path.duration; time += 0.1) {
    const Rigid3 pose = world.path.world_from_camera(time);
    const Vector3d in_camera = pose.rotation.conjugate() * Velocity(world.path, time);
    (in_camera.x() > 0 ? right : left) += 0.1 * std::abs(in_camera.x());
    EXPECT_LT(std::abs(in_camera.z()), 0.15) << time;
  }
  EXPECT_GT(std::min(left, right), 8);
}

TEST(Rotation, TurnsAboutTheCameraBeforeItWalks) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = Make("rotation", seed);
    const Vector3d stand = world.path.world_from_camera(0).translation;
    double turned = 0, time = 0;
    Rigid3 last = world.path.world_from_camera(0);
    for (; time < world.path.duration; time += 0.05) {
      const Rigid3 now = world.path.world_from_camera(time);
      if ((now.translation - stand).norm() > 1e-12) break;
      turned += AngularDistance(last.rotation, now.rotation);
      last = now;
    }
    EXPECT_GT(time, 10);
    EXPECT_GT(turned, 3);
    double walked = 0;
    for (; time < world.path.duration; time += 0.05) {
      const Rigid3 now = world.path.world_from_camera(time);
      walked += (now.translation - last.translation).norm();
      last = now;
    }
    EXPECT_GT(walked, 6);
  }
}

TEST(Static, HardlyMoves) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = Make("static", seed);
    std::vector<Rigid3> poses;
    for (double time = 0; time < world.path.duration; time += 0.25) {
      poses.push_back(world.path.world_from_camera(time));
    }
    double farthest = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const bool early = i < 60;  // 15 s
      for (std::size_t k = 0; k < i; ++k) {
        const double moved = (poses[i].translation - poses[k].translation).norm();
        EXPECT_LT(moved, early ? 0.01 : 0.02);
        EXPECT_LT(AngularDistance(poses[i].rotation, poses[k].rotation), 0.02);
        farthest = std::max(farthest, moved);
      }
    }
    EXPECT_GT(farthest, 0.003);
  }
}

TEST(Lights, AreSwitchedQuicklyButNotAtOnce) {
  constexpr double kStep = 0.01;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = Make("lights", seed);
    ASSERT_GE(world.scene.circuits.size(), 3U);
    for (const Circuit& circuit : world.scene.circuits) {
      int on = 0, off = 0, between = 0;
      for (double time = 0; time < world.path.duration; time += kStep) {
        const double level = circuit.level(time);
        ASSERT_GE(level, -1e-12);
        ASSERT_LE(level, 1 + 1e-12);
        EXPECT_LT(std::abs(circuit.level(time + kStep) - level), 0.25) << time;
        ++(level > 0.99 ? on : level < 0.01 ? off : between);
      }
      EXPECT_GT(std::min(on, off), 200);  // 2 s
      EXPECT_GT(between, 4);
      EXPECT_LT(between, 200);
    }
  }
}

TEST(Lights, DaylightStaysAndTheCameraFollows) {
  const World world = Make("lights");
  EXPECT_TRUE(std::any_of(world.scene.lamps.begin(), world.scene.lamps.end(), [](const Lamp& lamp) {
    return lamp.circuit == 0 && lamp.power > 0.5;
  }));
  SynthOptions options;
  ASSERT_NE(FindWorld("lights").adjust, nullptr);
  FindWorld("lights").adjust(options);
  EXPECT_TRUE(options.auto_exposure);
}

TEST(Dynamic, MovingThingsFillAShareOfTheView) {
  const World world = Make("dynamic");
  const RayTracer tracer(world.scene);
  double sum = 0;
  int count = 0;
  for (double time = 0; time < world.path.duration; time += 0.5, ++count) {
    const std::vector<unsigned> seen = Seen(tracer, world, time);
    const auto moving = std::count_if(seen.begin(), seen.end(), [&](unsigned hit) {
      return hit != RayTracer::kNothing && world.scene.surfaces[hit].body;
    });
    const double share = static_cast<double>(moving) / static_cast<double>(seen.size());
    EXPECT_LT(share, 0.5) << time;
    sum += share;
  }
  EXPECT_GT(sum / count, 0.03);
  EXPECT_LT(sum / count, 0.3);
}

TEST(Dynamic, BodiesMoveWithoutJumps) {
  constexpr double kStep = 1e-3;
  const World world = Make("dynamic");
  ASSERT_GE(world.scene.bodies.size(), 10U);
  for (std::size_t i = 0; i < world.scene.bodies.size(); ++i) {
    const Body& body = world.scene.bodies[i];
    double farthest = 0, most_turn = 0;
    for (double time = 0; time < world.path.duration; time += 0.0103) {
      const Rigid3 a = body.world_from_body(time), b = body.world_from_body(time + kStep);
      EXPECT_LT((a.translation - b.translation).norm(), 3 * kStep) << i << " at " << time;
      EXPECT_LT(AngularDistance(a.rotation, b.rotation), 7 * kStep) << i << " at " << time;
      const Rigid3 start = body.world_from_body(0);
      farthest = std::max(farthest, (a.translation - start.translation).norm());
      most_turn = std::max(most_turn, AngularDistance(a.rotation, start.rotation));
    }
    EXPECT_TRUE(farthest > 0.5 || most_turn > 0.5) << i;
  }
}

// Edges beside an edge, parallel to it and within reach of a wrong match.
std::ptrdiff_t TwinsOf(const Segment3& edge, const std::vector<Segment3>& edges) {
  const double length = (edge.end - edge.start).norm();
  const Vector3d along = (edge.end - edge.start) / length;
  const Vector3d middle = 0.5 * (edge.start + edge.end);
  return std::count_if(edges.begin(), edges.end(), [&](const Segment3& other) {
    const Vector3d way = (other.end - other.start).normalized();
    const Vector3d offset = 0.5 * (other.start + other.end) - middle;
    const double apart = offset.cross(along).norm();
    return way.cross(along).norm() < 0.01 && apart > 0.03 && apart < 0.3 &&
           std::abs(offset.dot(along)) < 0.5 * length;
  });
}

// In a furnished room less than half of the long edges have so many.
TEST(Wires, MostLongEdgesHaveManyTwins) {
  constexpr double kLong = 0.4;
  constexpr int kMany = 8, kStep = 3;
  for (const std::uint64_t seed : {1U, 2U}) {
    const std::vector<Segment3> edges = Make("wires", seed).scene.edges;
    int tried = 0, with_twins = 0;
    for (std::size_t i = 0; i < edges.size(); i += kStep) {
      if ((edges[i].end - edges[i].start).norm() < kLong) continue;
      ++tried;
      with_twins += TwinsOf(edges[i], edges) >= kMany ? 1 : 0;
    }
    EXPECT_GT(tried, 500);
    EXPECT_GT(with_twins, 0.8 * tried);
  }
}

// Sine of the angle between the plane of a line through the camera and a translation.
double OffPlane(const Segment3& line, const Vector3d& camera, const Vector3d& translation) {
  const Vector3d normal = (line.start - camera).cross(line.end - camera).normalized();
  return std::abs(normal.dot(translation.normalized()));
}

TEST(Degenerate, LongLinesLieInEpipolarPlanes) {
  constexpr double kLong = 2, kMost = 0.02;
  const World world = Make("degenerate");
  int sides = 0;
  double along = 0, across = 0;
  for (double time = 0; time < world.path.duration; time += 0.5) {
    const Rigid3 pose = world.path.world_from_camera(time);
    const Vector3d baseline = pose.rotation * Vector3d(kBaseline, 0, 0);
    const Vector3d velocity = Velocity(world.path, time);
    along += std::abs(velocity.x());
    across += velocity.tail<2>().norm();
    for (const Segment3& edge : world.scene.edges) {
      const Vector3d way = edge.end - edge.start;
      // The ends of the hall's floor and ceiling are the only others.
      if (way.norm() < kLong || std::abs(way.x()) < 0.99 * way.norm()) continue;
      ++sides;
      EXPECT_LT(OffPlane(edge, pose.translation, baseline), kMost) << time;
    }
  }
  EXPECT_GT(sides, 1000);
  EXPECT_GT(along, 20 * across);
}

TEST(Degenerate, WhatIsNotAlongTheBaselineIsShort) {
  const World world = Make("degenerate");
  double along = 0, other = 0;
  for (const Segment3& edge : world.scene.edges) {
    const Vector3d way = edge.end - edge.start;
    // Only what the camera faces; the ends of the hall are out of its view most of the time.
    const double x = 0.5 * (edge.start + edge.end).x();
    if (x < 1 || x > 19) continue;
    (std::abs(way.x()) > 0.99 * way.norm() ? along : other) += way.norm();
  }
  EXPECT_GT(along, 5 * other);
}

}  // namespace
}  // namespace plumbline
