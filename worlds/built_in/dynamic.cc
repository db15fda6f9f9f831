// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/track.h"
#include "worlds/built_in/worlds.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace plumbline {
namespace dynamic {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kWidth = 12, kDepth = 9, kHeight = 3.8;
const Vector2d kCarousel(5.2, 6.4);  // its middle

Eigen::Quaterniond Turn(double yaw) { return ExpSo3(yaw * Vector3d::UnitZ()); }

// A limb that swings about the joint at its upper end; front is x.
void AddLimb(SceneBuilder& scene,
             const Track& track,
             const Vector3d& joint,
             double swing,
             const BoxShape& box) {
  scene.BeginBody([track, joint, swing](double time) {
    constexpr double kStride = 1.35;  // metres for a left and a right step
    const double angle = swing * math::Sin(2 * kPi * std::abs(track.speed) * time / kStride);
    return track.At(time) * Rigid3{ExpSo3(angle * Vector3d::UnitY()), joint};
  });
  scene.AddBox(box, Material::kFabric, scene.Random(0.15, 0.6));
  scene.EndBody();
}

void AddWalker(SceneBuilder& scene, const Track& track) {
  scene.BeginBody([track](double time) { return track.At(time); });
  const double shirt = scene.Random(0.2, 0.8);
  scene.AddBox({{0, 0, 0.86}, {0.22, 0.4, 0.6}}, Material::kFabric, shirt);
  scene.AddBox({{0, 0, 1.46}, {0.1, 0.11, 0.08}}, Material::kPaint, 0.55);
  scene.AddBox({{0.01, 0, 1.54}, {0.2, 0.16, 0.23}}, Material::kPaint, 0.55);
  scene.AddBox({{-0.02, 0, 1.7}, {0.22, 0.18, 0.09}}, Material::kFabric, 0.15);  // hair
  scene.AddBox({{-0.2, 0, 0.95}, {0.16, 0.3, 0.42}}, Material::kFabric, scene.Random(0.1, 0.7));
  scene.EndBody();
  for (const double side : {-1.0, 1.0}) {
    AddLimb(scene, track, {0, 0.1 * side, 0.86}, 0.42 * side, {{0, 0, -0.84}, {0.15, 0.15, 0.83}});
    AddLimb(scene, track, {0, 0.26 * side, 1.43}, -0.35 * side, {{0, 0, -0.62}, {0.1, 0.1, 0.62}});
  }
}

// A belt around an island, with cases on it.
void AddCarousel(SceneBuilder& scene) {
  constexpr double kBelt = 0.9, kTall = 0.38, kLong = 5.6, kBroad = 3.0, kRim = 0.05;
  const Vector3d middle(kCarousel.x(), kCarousel.y(), 0);
  for (const double side : {-0.5, 0.5}) {
    scene.AddBox({middle + Vector3d(0, side * (kBroad - kBelt), 0), {kLong, kBelt, kTall}},
                 Material::kMetal,
                 0.3);
    scene.AddBox(
        {middle + Vector3d(side * (kLong - kBelt), 0, 0), {kBelt, kBroad - 2 * kBelt, kTall}},
        Material::kMetal,
        0.3);
    // A bright rim outside.
    scene.AddBox({middle + Vector3d(0, side * (kBroad + kRim), 0), {kLong, kRim, kTall + 0.06}},
                 Material::kBlank,
                 0.75);
    scene.AddBox(
        {middle + Vector3d(side * (kLong + kRim), 0, 0), {kRim, kBroad + 2 * kRim, kTall + 0.06}},
        Material::kBlank,
        0.75);
  }
  const Vector2d island(kLong - 2 * kBelt, kBroad - 2 * kBelt);
  scene.AddBox({middle, {island.x(), island.y(), 0.7}}, Material::kPaint, 0.6);
  scene.AddBox({middle + Vector3d(-0.7, 0, 0.7), {1.6, 0.25, 1.1}}, Material::kPoster, 0.8);
  scene.AddBox({middle + Vector3d(1.1, 0, 0.7), {0.9, 0.3, 0.7}}, Material::kMural, 0.5);
  constexpr int kCases = 8;
  const Vector2d half(0.5 * (kLong - kBelt), 0.5 * (kBroad - kBelt));
  for (int i = 0; i < kCases; ++i) {
    const Track track{kCarousel, half, 0.45, 0.35, 1.75 * i + scene.Random(-0.3, 0.3), kTall};
    const Vector3d size(
        scene.Random(0.45, 0.75), scene.Random(0.22, 0.35), scene.Random(0.35, 0.55));
    const double turn = scene.Random(-0.3, 0.3), tone = scene.Random(0.15, 0.8);
    const Material looks[] = {Material::kFabric, Material::kCardboard, Material::kMetal};
    scene.BeginBody([track](double time) { return track.At(time); });
    scene.AddBox({{0, 0, 0.002}, size, turn}, looks[i % 3], tone);
    scene.AddBox({{0, 0, size.z() + 0.002}, {0.2, 0.03, 0.04}, turn}, Material::kBlank, 0.15);
    scene.AddBox(
        {{0, 0, 0.001}, size + Vector3d(-0.25, 0.012, 0.006), turn}, looks[i % 3], 0.7 * tone);
    scene.EndBody();
  }
}

// A fan of four blades under the ceiling, and its rod.
void AddFan(SceneBuilder& scene, const Vector3d& hub, double turns_per_s) {
  scene.AddBar(
      hub + Vector3d(0, 0, 0.08), {hub.x(), hub.y(), kHeight}, 0.04, Material::kMetal, 0.4);
  scene.BeginBody([hub, turns_per_s](double time) {
    return Rigid3{Turn(2 * kPi * turns_per_s * time), hub};
  });
  scene.AddBox({{0, 0, -0.05}, {0.18, 0.18, 0.12}}, Material::kBlank, 0.7);
  for (int i = 0; i < 4; ++i) {
    const double yaw = 0.5 * kPi * i;
    scene.AddBox({{0.45 * math::Cos(yaw), 0.45 * math::Sin(yaw), 0}, {0.7, 0.14, 0.012}, yaw},
                 Material::kWood,
                 0.4);
  }
  scene.EndBody();
}

// A door that people went through again and again, and the passage behind it.
void AddSwingDoor(SceneBuilder& scene, const Place& wall, const Opening& hole, double period) {
  constexpr double kPassage = 1.6, kWall = 0.24, kMost = 1.35;
  const Place corner{wall.At(hole.along, 0, 0), wall.facing};
  const Vector3d along = hole.width * Along(wall), up = hole.height * Vector3d::UnitZ();
  const Vector3d back = (kWall - kPassage) * Out(wall);
  const Vector3d left = corner.At(0, -kWall, 0);
  const PanelLook look{Material::kPaint, 0.55, false};
  scene.AddPanel(left, back, up, look);
  scene.AddPanel(left + along + back, -back, up, look);
  scene.AddPanel(left + along + back, -along, up, {Material::kPoster, 0.7, false});
  scene.AddPanel(left, along, back, {Material::kTiles, 0.5, false});
  scene.AddPanel(left + up, back, along, look);
  AddDoorFrame(scene,
               {wall.At(hole.along + 0.5 * hole.width, 0, 0), wall.facing},
               {hole.width, hole.height});
  const Vector3d hinge = corner.At(0.01, -0.03, 0);
  const double closed = wall.facing - 0.5 * kPi;
  scene.BeginBody([hinge, closed, period](double time) {
    const double open = 0.5 - 0.5 * math::Cos(2 * kPi * time / period);
    return Rigid3{Turn(closed + kMost * open * open), hinge};
  });
  AddOpenLeaf(scene, {Vector3d::Zero(), 0}, {hole.width - 0.02, hole.height - 0.01, 3, 0.7});
  scene.EndBody();
}

// A pillar with bills that turns slowly.
void AddTurningPillar(SceneBuilder& scene, const Vector3d& foot) {
  scene.AddBox({foot, {0.5, 0.5, 0.3}}, Material::kMetal, 0.35);
  scene.BeginBody([foot](double time) {
    return Rigid3{Turn(0.45 * time), foot + Vector3d(0, 0, 0.31)};
  });
  scene.AddBox({Vector3d::Zero(), {0.85, 0.85, 1.7}}, Material::kPoster, 0.8);
  scene.EndBody();
}

void Furnish(SceneBuilder& scene, const ShellShape& shell) {
  for (const double along : {1.5, 4.6, 8.9}) {
    AddPicture(scene, shell.Wall(2, along, 1.3), {1.5, 1.0}, Material::kPoster);
  }
  AddSheet(scene, shell.Wall(2, 6.8, 2.4), {3.2, 0.9}, Material::kScreen, 0.6);
  AddPicture(scene, shell.Wall(1, 2.0, 1.2), {0.9, 1.3}, Material::kPoster);
  AddCabinet(scene, shell.Wall(1, 3.6), {1.4, 0.45, 1.3}, 3, 0.6);
  AddPicture(scene, shell.Wall(1, 7.2, 1.1), {2.2, 1.4}, Material::kMural);
  AddShelf(scene, shell.Wall(3, 1.6), {1.8, 1.6, 0.34, 4, 0.9, 0.5});
  AddDoor(scene, shell.Wall(0, 2.2), {});
  AddCabinet(scene, shell.Wall(0, 5.5), {1.6, 0.45, 1.0}, 3, 0.6);
  AddPicture(scene, shell.Wall(0, 8.0, 1.3), {1.2, 0.9}, Material::kPoster);
  AddPlant(scene, shell.Wall(2, 0.5), 1.7);
  AddPlant(scene, shell.Wall(2, 11.4), 1.5);
  AddPlant(scene, shell.Wall(1, 5.2), 1.4);
  for (const double x : {1.7, 6.0, 10.3}) {  // columns
    scene.AddBox({{x, 4.55, 0}, {0.35, 0.35, kHeight}}, Material::kConcrete, 0.55);
    AddSheet(scene, {{x, 4.375, 1.3}, -0.5 * kPi}, {0.3, 0.45}, Material::kPoster, 0.8);
  }
  for (const double x : {3.2, 8.8}) {  // few: each costs time in scenes with motion
    for (const double y : {2.4, 6.4}) {
      AddTubeLamp(scene, {{x, y, kHeight - 0.3}, 0}, {1.8, 10});
    }
  }
  AddSocket(scene, shell.Wall(1, 4.6, 0.4));
  AddSocket(scene, shell.Wall(2, 3.2, 0.4));
}

void AddPeople(SceneBuilder& scene) {
  const double pace = scene.Random(1.0, 1.2);
  // To and fro before the carousel, around it, and at the far side.
  AddWalker(scene, {{5.6, 3.9}, {4.0, 0.28}, 0.25, pace, scene.Random(0, 8)});
  AddWalker(scene, {{5.6, 3.9}, {4.0, 0.28}, 0.25, pace, 8.4 + scene.Random(0, 0.4)});
  AddWalker(scene, {kCarousel, {3.6, 2.1}, 0.6, -0.9, scene.Random(0, 20)});
  AddWalker(scene, {{10.0, 3.2}, {1.2, 0.9}, 0.5, 0.8, scene.Random(0, 6)});
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  ShellShape shell;
  shell.size = {kWidth, kDepth, kHeight};
  shell.walls = {Finish{Material::kPlaster, 0.6},
                 {Material::kPaint, 0.6},
                 {Material::kPlaster, 0.65},
                 {Material::kConcrete, 0.55}};
  shell.floor = {Material::kTiles, 0.5};
  shell.ceiling = {Material::kAcoustic, 0.7};
  shell.openings[2].push_back({2.5, 1.0, 0, 2.1});
  shell.openings[3].push_back({3.6, 4.6, 0.9, 1.8});
  AddShell(scene, shell);
  AddSkirting(scene, shell, {Material::kPaint, 0.3});
  for (const Opening& hole : shell.openings[3]) {
    AddViewWindow(scene, shell.Wall(3), hole, {4, 5, 0.5});
  }
  AddSwingDoor(scene, shell.Wall(2), shell.openings[2].front(), scene.Random(5, 7));
  Furnish(scene, shell);
  AddCarousel(scene);
  AddTurningPillar(scene, {10.4, 6.6, 0});
  AddFan(scene, {3.4, 4.9, 3.2}, 0.9);
  AddFan(scene, {8.0, 4.9, 3.2}, -0.7);
  AddPeople(scene);
  scene.SetAmbient(0.3);

  // Along the near side of the hall by hand, and back, looking across it.
  const double y = 1.7 + scene.Random(-0.1, 0.1);
  constexpr double kAhead = 0.5 * kPi;
  std::vector<Waypoint> way;
  const auto pass = [&](double x, double dy, double turn) {
    way.push_back({{x, y + dy, scene.Random(1.5, 1.6)}, kAhead + turn, 0.06});
  };
  for (int round = 0; round < 2; ++round) {
    pass(2.0, 0, -0.3);
    pass(3.5, 0.3, -0.1);
    pass(5.0, 0.4, 0.2);
    pass(6.5, 0, 0.3);
    pass(7.6, -0.3, -0.2);
    pass(7.8, 0.2, -0.7);
    pass(6.8, 0.4, 0);
    pass(4.8, -0.2, 0.5);
    pass(3.2, -0.4, 0.3);
  }
  pass(2.0, 0, -0.3);
  return {scene.Take(), WithCarrier(SplinePath(way, {0.6, 0.6}), Carrier::kHand, seed)};
}

}  // namespace dynamic

World MakeDynamic(std::uint64_t seed) { return dynamic::Make(seed); }

}  // namespace plumbline
