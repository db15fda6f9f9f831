// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/worlds.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace plumbline {
namespace vicon {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNorth = 0.5 * kPi, kSouth = -0.5 * kPi, kEast = 0, kWest = kPi;
constexpr double kWidth = 8, kDepth = 8.5, kHeight = 4;

void AddMats(SceneBuilder& scene) {
  constexpr double kLong = 1.95, kShort = 0.97, kThick = 0.05;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 2; ++column) {
      const Vector3d at(2.9 + 2.0 * column + scene.Random(-0.01, 0.01),
                        2.6 + 1.0 * row + scene.Random(-0.006, 0.006),
                        0);
      const double tone = (row + column) % 2 == 0 ? 0.22 : 0.5;
      scene.AddBox({at, {kLong, kShort, kThick}, 0}, Material::kFabric, tone);
    }
  }
}

// Crates, drums and boxes around the mats, low enough to fly over or close to the walls.
void AddObstacles(SceneBuilder& scene) {
  for (const double x : {1.05, 1.8}) {
    const double tall = scene.Random(0.8, 0.95);
    scene.AddPrism({x, 0.95, 0}, {x, 0.95, tall}, {0.32, 12, 0.02}, Material::kMetal, 0.45);
  }
  scene.AddPrism({7.2, 5.3, 0}, {7.2, 5.3, 0.9}, {0.3, 12, 0.02}, Material::kMetal, 0.3);
  AddStack(scene, {{6.9, 0.35, 0}, kNorth});
  AddStack(scene, {{6.2, 0.45, 0}, kNorth});
  AddStack(scene, {{0.4, 3.1, 0}, kEast});
  AddStack(scene, {{7.5, 7.9, 0}, kSouth});
  for (int i = 0; i < 3; ++i) {  // crates
    const double side = 0.62 - 0.08 * i;
    scene.AddBox({{1.0, 6.9, 0.62 * i - 0.04 * i * (i - 1)}, {side, side, side}, 0.2 * i},
                 Material::kWood,
                 0.5 + 0.05 * i);
  }
  // A block of foam and a low box among the mats.
  scene.AddBox({{4.0 + scene.Random(-0.2, 0.2), 4.1, 0.05}, {0.6, 0.5, 0.45}, scene.Random(0, 1)},
               Material::kFabric,
               0.45);
  scene.AddBox({{3.0, 5.0, 0.05}, {0.5, 0.35, 0.3}, scene.Random(0, 1)}, Material::kCardboard, 0.5);
}

// A ladder that leans against the wall x = 0.
void AddLadder(SceneBuilder& scene, double y) {
  const auto at = [y](double side, double share) {
    return Vector3d(0.75 - 0.68 * share, y + side, 0.03 + 2.9 * share);
  };
  for (const double side : {-0.2, 0.2}) {
    scene.AddBar(at(side, 0), at(side, 1), 0.05, Material::kMetal, 0.6);
  }
  for (int i = 1; i < 10; ++i) {
    scene.AddBar(at(-0.2, 0.1 * i), at(0.2, 0.1 * i), 0.03, Material::kMetal, 0.6);
  }
}

// The rail with the cameras of the tracking system, under the ceiling.
void AddCameraRig(SceneBuilder& scene) {
  constexpr double kOff = 0.45, kRail = 3.45, kThick = 0.05;
  const Vector3d corners[4] = {{kOff, kOff, kRail},
                               {kWidth - kOff, kOff, kRail},
                               {kWidth - kOff, kDepth - kOff, kRail},
                               {kOff, kDepth - kOff, kRail}};
  const Vector3d target(0.5 * kWidth, 0.5 * kDepth, 1.0);
  for (int i = 0; i < 4; ++i) {
    // Those along y lie on those along x.
    const Vector3d raised = (i % 2 == 0 ? 0 : kThick) * Vector3d::UnitZ();
    const Vector3d a = corners[i] + raised, b = corners[(i + 1) % 4] + raised;
    scene.AddBar(a, b, kThick, Material::kMetal, 0.65);
    for (const double share : {0.02, 0.35, 0.68}) {
      const Vector3d at = a + share * (b - a);
      scene.AddBar(
          at + Vector3d(0, 0, 0.03), {at.x(), at.y(), kHeight}, 0.03, Material::kMetal, 0.5);
      const Vector3d way = (target - at).normalized();
      const Eigen::Quaterniond attitude =
          ExpSo3(math::Atan2(way.y(), way.x()) * Vector3d::UnitZ()) *
          ExpSo3(-math::Asin(way.z()) * Vector3d::UnitY());
      const Vector3d body = at + Vector3d(0, 0, -0.14) + 0.05 * way;
      scene.AddPlacedBox({attitude, body}, {0.17, 0.13, 0.13}, Material::kPaint, 0.12);
      scene.AddPlacedBox({attitude, body + 0.11 * way}, {0.06, 0.07, 0.07}, Material::kPaint, 0.3);
    }
  }
}

void AddWalls(SceneBuilder& scene) {
  AddCurtain(scene, {{5.1, kDepth, 0.05}, kSouth}, {4.6, 3.1}, 0.35);
  AddCurtain(scene, {{kWidth, 2.6, 0.05}, kWest}, {3.6, 3.1}, 0.5);
  AddChecker(scene, {{2.6, 0, 0.9}, kNorth}, 7, 6, 0.11);
  AddChecker(scene, {{0, 5.3, 1.2}, kEast}, 6, 5, 0.09);
  AddDoor(scene, {{1.3, kDepth, 0}, kSouth}, {0.95, 2.1, 3, 0.6});
  AddSheet(scene, {{4.4, 0, 1.1}, kNorth}, {1.7, 1.15}, Material::kMural, 0.5);
  AddSheet(scene, {{6.5, 0, 1.3}, kNorth}, {0.8, 1.1}, Material::kPoster, 0.85);
  AddSheet(scene, {{0, 3.9, 1.3}, kEast}, {0.75, 1.0}, Material::kPoster, 0.8);
  AddSheet(scene, {{kWidth, 5.5, 1.2}, kWest}, {1.3, 0.9}, Material::kPoster, 0.8);
  AddSheet(scene, {{kWidth, 7.0, 0.1}, kWest}, {1.1, 2.0}, Material::kFabric, 0.3);
  for (const double z : {2.75, 2.95}) {  // heating pipes
    scene.AddPrism({0.12, 0.05, z}, {0.12, kDepth - 0.05, z}, {0.05, 8, 0}, Material::kPaint, 0.6);
  }
  AddDuct(scene, {{4.0, 0, 2.6}, kNorth}, 7.6);
  TableShape table;
  AddTable(scene, {{0.03, 1.9 + 0.6, 0}, kEast}, table);
  AddClutter(scene, {{0.03, 1.9 + 0.6, 0}, kEast}, table, 4);
  AddScreen(scene, {{0.12, 1.9 + 0.6, table.height + 0.002}, kEast});
  AddLadder(scene, 4.6 + 3.2);
}

void AddCeilingThings(SceneBuilder& scene) {
  for (const double y : {1.4, 3.3, 5.2, 7.1}) {
    scene.AddBox(
        {{0.5 * kWidth, y, kHeight - 0.2}, {kWidth - 0.01, 0.12, 0.196}, 0}, Material::kPaint, 0.5);
    if (y > 7) break;
    for (const double x : {2.0, 6.0}) {
      scene.AddCeilingLamp({x, y + 0.95, kHeight - 0.12}, {1.5, 0.22}, 5.2);
      scene.AddBox({{x, y + 0.95, kHeight - 0.115}, {1.54, 0.26, 0.113}, 0}, Material::kPaint, 0.8);
    }
  }
}

Scene MakeHall(std::uint64_t seed) {
  SceneBuilder scene(seed);
  RoomPlan hall;
  hall.high = {kWidth, kDepth};
  hall.height = kHeight;
  hall.wall = Material::kPaint;
  hall.wall_tone = 0.65;
  hall.floor = Material::kConcrete;
  hall.floor_tone = 0.42;
  hall.grid = false;
  AddBuilding(scene, std::vector{hall}, {});
  AddMats(scene);
  AddObstacles(scene);
  AddWalls(scene);
  AddCameraRig(scene);
  AddCeilingThings(scene);
  scene.SetAmbient(0.5);
  return scene.Take();
}

// Flight of the vehicle.
struct Flight {
  int legs = 14;
  Pace pace;
  double gaze = 0.5;  // how far it looks away from the middle of the room, radians
  double low = 1.0, high = 1.8;
  double roll = 0;
};

// Around the middle of the room, looking across it.
CameraPath MakeFlight(const Flight& flight, std::uint64_t seed) {
  SceneBuilder random(seed + 77);
  const double turn = random.Random(0, 1) < 0.5 ? -1 : 1;
  double angle = random.Random(-kPi, kPi);
  std::vector<Waypoint> waypoints;
  for (int i = 0; i <= flight.legs; ++i) {
    const double radius = random.Random(1.3, 2.3);
    Waypoint at;
    at.position = {0.5 * kWidth + radius * math::Cos(angle),
                   0.5 * kDepth + radius * math::Sin(angle),
                   i == 0 ? 0.9 : random.Random(flight.low, flight.high)};
    at.yaw = angle + kPi + random.Random(-flight.gaze, flight.gaze);
    at.pitch = 0.1 + 0.3 * (at.position.z() - 1.0) * random.Random(0.2, 1);
    at.roll = random.Random(-flight.roll, flight.roll);
    at.pause = i == 0 ? 1 : 0;
    waypoints.push_back(at);
    angle += turn * random.Random(0.6, 1.2);
  }
  return WithCarrier(SplinePath(waypoints, flight.pace), Carrier::kDrone, seed);
}

World MakeViconEasy(std::uint64_t seed) {
  return {MakeHall(seed), MakeFlight({14, {0.5, 0.4}, 0.4, 1.0, 1.7, 0}, seed)};
}

World MakeViconMedium(std::uint64_t seed) {
  return {MakeHall(seed), MakeFlight({24, {1.0, 0.9}, 0.8, 0.9, 2.2, 0.05}, seed)};
}

World MakeViconDifficult(std::uint64_t seed) {
  return {MakeHall(seed), MakeFlight({38, {1.8, 1.8}, 1.3, 0.9, 2.5, 0.12}, seed)};
}

}  // namespace vicon

World MakeViconEasy(std::uint64_t seed) { return vicon::MakeViconEasy(seed); }
World MakeViconMedium(std::uint64_t seed) { return vicon::MakeViconMedium(seed); }
World MakeViconDifficult(std::uint64_t seed) { return vicon::MakeViconDifficult(seed); }

}  // namespace plumbline
