// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace plumbline {
namespace wires {

using Eigen::Vector3d;

constexpr double kWidth = 9, kDepth = 7, kHeight = 3.2;

// Boards on edge with gaps between, from floor to ceiling.
void AddCladding(SceneBuilder& scene, const Place& wall, double length) {
  constexpr double kPitch = 0.095, kBoard = 0.045;
  const int count = static_cast<int>(length / kPitch);
  // The boards' own x points up, so that their grain does.
  Eigen::Matrix3d axes;
  axes << Vector3d::UnitZ(), wall.At(0, 1, 0) - wall.base, wall.base - wall.At(1, 0, 0);
  for (int i = 0; i < count; ++i) {
    scene.AddPlacedBox(
        {Eigen::Quaterniond(axes), wall.At(kPitch * (i + 0.5), 0.04, 0.5 * kHeight - 0.05)},
        {kHeight - 0.3, 0.05, kBoard},
        Material::kWood,
        scene.Random(0.45, 0.6));
  }
}

// Upright bars between two rails.
void AddRailing(SceneBuilder& scene, const Place& place, double length, double foot) {
  constexpr double kPitch = 0.12, kTall = 0.95;
  const int count = static_cast<int>(length / kPitch);
  for (const double z : {foot + 0.08, foot + kTall}) {
    AddPart(scene, place, {{0.5 * length, 0, z}, {length, 0.045, 0.035}}, Material::kMetal, 0.3);
  }
  for (int i = 0; i < count; ++i) {
    AddPart(scene,
            place,
            {{length * (i + 0.5) / count, 0, foot + 0.115}, {0.018, 0.018, kTall - 0.115}},
            Material::kBlank,
            0.25);
  }
}

// A fence of wires: the upright ones stand before the level ones.
void AddFence(SceneBuilder& scene, const Place& place, double length, double tall) {
  constexpr double kPitch = 0.1, kWire = 0.008;
  for (double x = 0; x < length + 0.01; x += 0.5 * length) {
    AddPart(scene, place, {{x, -0.03, 0}, {0.05, 0.045, tall + 0.05}}, Material::kMetal, 0.4);
  }
  for (double x = 0.5 * kPitch; x < length; x += kPitch) {
    AddBarAt(scene, place, {{x, kWire, 0.05}, {x, kWire, tall}, kWire}, Material::kBlank, 0.7);
  }
  for (double z = 0.1; z < tall; z += kPitch) {
    AddBarAt(scene, place, {{0, 0, z}, {length, 0, z}, kWire - 0.002}, Material::kBlank, 0.7);
  }
}

// Steel shelves of level wires, with a few boxes.
void AddWireShelf(SceneBuilder& scene, const Place& place) {
  constexpr double kLong = 1.6, kDeep = 0.45;
  for (const double x : {0.02, kLong - 0.02}) {
    for (const double y : {0.02, kDeep - 0.02}) {
      AddPart(scene, place, {{x, y, 0}, {0.03, 0.03, 1.9}}, Material::kMetal, 0.5);
    }
  }
  for (const double z : {0.15, 0.7, 1.25, 1.8}) {
    for (int i = 0; i < 8; ++i) {
      const double y = 0.06 + (kDeep - 0.12) * i / 7;
      AddBarAt(scene, place, {{0.04, y, z}, {kLong - 0.04, y, z}, 0.008}, Material::kBlank, 0.75);
    }
    for (int i = 0; i < 2; ++i) {
      if (z > 1.5 || scene.Random(0, 1) < 0.3) continue;
      AddPart(scene,
              place,
              {{0.4 + 0.8 * i, 0.5 * kDeep, z + 0.006},
               {scene.Random(0.25, 0.5), 0.28, scene.Random(0.15, 0.35)}},
              Material::kCardboard,
              scene.Random(0.35, 0.7));
    }
  }
}

// Cables side by side on the wall that go up and turn along a tray.
void AddCables(SceneBuilder& scene, const Place& wall, double x, double length) {
  constexpr int kCables = 7;
  constexpr double kPitch = 0.035, kThick = 0.014, kTray = 2.45;
  for (int i = 0; i < kCables; ++i) {
    const double at = x + kPitch * i, z = kTray + kPitch * (kCables - i);
    AddBarAt(scene,
             wall,
             {{at, 0.03, 0.3}, {at, 0.03, z}, kThick},
             Material::kBlank,
             scene.Random(0.1, 0.7));
    AddBarAt(scene,
             wall,
             {{at + 0.01, 0.03, z}, {x + length, 0.03, z}, kThick},
             Material::kBlank,
             scene.Random(0.1, 0.7));
  }
  for (double along = x + 0.5; along < x + length; along += 0.6) {  // clips
    AddPart(scene, wall, {{along, 0.03, kTray + 0.015}, {0.03, 0.03, 0.28}}, Material::kBlank, 0.5);
  }
  AddPart(scene, wall, {{x + 0.1, 0.06, 0.18}, {0.4, 0.1, 0.14}}, Material::kMetal, 0.5);
}

void AddPlatform(SceneBuilder& scene) {
  constexpr double kStep = 0.16, kLong = 2.6, kBroad = 1.6;
  const Vector3d middle(0.5 * kWidth, 0.5 * kDepth, 0);
  scene.AddBox({middle, {kLong, kBroad, kStep}}, Material::kConcrete, 0.5);
  const double x = 0.5 * kLong - 0.05, y = 0.5 * kBroad - 0.05;
  const double quarter = 0.5 * std::numbers::pi;
  AddRailing(scene, {middle + Vector3d(-x + 0.03, -y, 0), quarter}, 2 * x - 0.06, kStep);
  AddRailing(scene, {middle + Vector3d(x, -y + 0.03, 0), 2 * quarter}, 2 * y - 0.06, kStep);
  AddRailing(scene, {middle + Vector3d(x - 0.03, y, 0), 3 * quarter}, 2 * x - 0.06, kStep);
  for (const double dx : {-x, x}) {
    for (const double dy : {-y, y}) {
      scene.AddBox({middle + Vector3d(dx, dy, kStep), {0.05, 0.05, 1.05}}, Material::kMetal, 0.3);
    }
  }
  scene.AddBox({middle + Vector3d(0.5, 0.1, kStep), {0.6, 0.5, 0.9}, 0.2}, Material::kMetal, 0.55);
  scene.AddBox(
      {middle + Vector3d(-0.5, 0, kStep), {0.4, 0.4, 0.5}, -0.3}, Material::kCardboard, 0.5);
}

void AddCeilingThings(SceneBuilder& scene) {
  for (int i = 0; i < 9; ++i) {  // rows of slats under the ceiling
    scene.AddBox({{0.5 + i, 0.5 * kDepth, kHeight - 0.12}, {0.05, kDepth - 0.01, 0.117}},
                 Material::kWood,
                 0.5);
  }
  for (const double y : {2.2, 2.35, 2.5, 4.6, 4.75}) {  // pipes across them
    scene.AddBox({{0.5 * kWidth, y, kHeight - 0.24}, {kWidth - 0.01, 0.06, 0.06}},
                 Material::kMetal,
                 scene.Random(0.4, 0.7));
  }
  for (const double x : {2.0, 4.5, 7.0}) {
    for (const double y : {1.6, 5.4}) AddTubeLamp(scene, {{x, y, kHeight - 0.4}, 0}, {1.5, 3.9});
  }
}

ShellShape Shell() {
  ShellShape shell;
  shell.size = {kWidth, kDepth, kHeight};
  shell.walls = {Finish{Material::kPaint, 0.65},
                 {Material::kPaint, 0.25},
                 {Material::kTiles, 0.7},
                 {Material::kPlaster, 0.55}};
  shell.floor = {Material::kConcrete, 0.45};
  shell.ceiling = {Material::kConcrete, 0.6};
  for (const double along : {0.8, 3.4, 6.0}) shell.openings[0].push_back({along, 1.9, 0.95, 1.5});
  return shell;
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const ShellShape shell = Shell();
  AddShell(scene, shell);
  AddSkirting(scene, shell, {Material::kPaint, 0.3});
  for (const Opening& hole : shell.openings[0]) {
    AddViewWindow(scene, shell.Wall(0), hole, {2, 3.5, 0.5, 32});
    AddRadiator(scene, shell.Wall(0, hole.along + 0.95), 1.7);
  }
  AddCladding(scene, shell.Wall(1, 0.1), kDepth - 0.2);
  AddCables(scene, shell.Wall(2), 0.7, 5.0);
  AddRadiator(scene, shell.Wall(2, 2.6), 1.6);
  AddWireShelf(scene, shell.Wall(2, 4.0));
  AddFence(scene, {shell.Wall(2, 6.2).At(0, 0.8, 0), shell.Wall(2).facing}, 2.5, 2.0);
  AddStack(scene, shell.Wall(2, 7.0));
  AddStack(scene, shell.Wall(2, 8.1));
  AddWireShelf(scene, shell.Wall(3, 0.9));
  AddWireShelf(scene, shell.Wall(3, 4.6));
  AddDoor(scene, shell.Wall(3, 3.5), {});
  AddPlatform(scene);
  AddCeilingThings(scene);
  scene.SetAmbient(0.25);

  // Around the platform by hand, looking now along the walls, now over it.
  const double x = 0.5 * kWidth, y = 0.5 * kDepth, away = scene.Random(-0.1, 0.1);
  std::vector<Waypoint> way;
  for (int k = 0; k < 16; ++k) {
    const double turn = 0.25 * std::numbers::pi * k;
    const double gaze = turn + (k % 4 < 2 ? 0.9 : 1.9);
    way.push_back({{x + (2.5 + away) * math::Cos(turn), y + (1.75 + away) * math::Sin(turn), 1.5},
                   gaze,
                   0.1});
  }
  return {scene.Take(), WithCarrier(SplinePath(way, {0.7, 0.6}), Carrier::kHand, seed)};
}

}  // namespace wires

World MakeWires(std::uint64_t seed) { return wires::Make(seed); }

}  // namespace plumbline
