// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/worlds.h"
#include "worlds/scene_builder.h"

#include <cmath>
#include <numbers>

namespace plumbline {
namespace room {

using Eigen::Vector3d;

constexpr double kWidth = 6.4, kDepth = 5.2, kHeight = 2.8;

// A table with four legs, its top at 0.75 m, with things on it.
void AddTable(SceneBuilder& scene, const Vector3d& place, double length, double yaw) {
  constexpr double kTop = 0.75, kThick = 0.04, kLeg = 0.06, kBreadth = 0.7;
  const double c = math::Cos(yaw), s = math::Sin(yaw);
  const auto at = [&](double x, double y, double z) -> Vector3d {
    return place + Vector3d(c * x - s * y, s * x + c * y, z);
  };
  scene.AddBox({at(0, 0, kTop - kThick), {length, kBreadth, kThick}, yaw}, Material::kWood, 0.6);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      scene.AddBox(
          {at(x * (length - 0.12), y * (kBreadth - 0.12), 0), {kLeg, kLeg, kTop - kThick}, yaw},
          Material::kMetal,
          0.35);
    }
  }
  for (int i = 0; i < 5; ++i) {
    const double x = length * (-0.4 + 0.2 * i);
    const Vector3d size(
        scene.Random(0.08, 0.2), scene.Random(0.08, 0.25), scene.Random(0.05, 0.35));
    const Material material = i % 2 == 0 ? Material::kCardboard : Material::kPoster;
    scene.AddBox({at(x, scene.Random(-0.15, 0.15), kTop), size, yaw + scene.Random(-0.6, 0.6)},
                 material,
                 scene.Random(0.25, 0.9));
  }
}

// A shelf against the wall y = `wall_y` (facing `side` = +1 or -1), filled with books and boxes.
void AddShelf(SceneBuilder& scene, double x, double wall_y, double side, double breadth) {
  constexpr double kTall = 1.95, kDeep = 0.32, kBoard = 0.025;
  constexpr int kLevels = 5;
  const double y = wall_y + side * (0.5 * kDeep + 0.01);
  for (const double end : {-0.5, 0.5}) {
    scene.AddBox({{x + end * breadth, y, 0}, {kBoard, kDeep, kTall}, 0}, Material::kWood, 0.5);
  }
  for (int level = 0; level <= kLevels; ++level) {
    const double z = 0.06 + level * (kTall - 0.1) / kLevels;
    scene.AddBox({{x, y, z}, {breadth - kBoard, kDeep, kBoard}, 0}, Material::kWood, 0.55);
    if (level == kLevels) break;
    double left = x - 0.5 * breadth + 0.03;
    while (left < x + 0.5 * breadth - 0.1) {
      const bool box = scene.Random(0, 1) < 0.12;
      const double wide = box ? scene.Random(0.12, 0.2) : scene.Random(0.02, 0.06);
      if (left + wide > x + 0.5 * breadth - 0.03) break;
      const double deep = scene.Random(0.18, 0.26), tall = scene.Random(0.2, 0.31);
      scene.AddBox({{left + 0.5 * wide, y, z + kBoard}, {wide, deep, tall}, 0},
                   box ? Material::kCardboard : Material::kSpine,
                   scene.Random(0.1, 0.95));
      left += wide + (scene.Random(0, 1) < 0.15 ? scene.Random(0.03, 0.12) : 0.002);
    }
  }
}

void AddDoor(SceneBuilder& scene, double x, double wall_y, double side) {
  constexpr double kBroad = 0.9, kTall = 2.05, kFrame = 0.08;
  const double y = wall_y + side * 0.022, frame_y = wall_y + side * 0.052;
  scene.AddBox({{x, y, 0}, {kBroad, 0.04, kTall}, 0}, Material::kPaint, 0.75);
  for (const double end : {-0.5, 0.5}) {
    scene.AddBox({{x + end * (kBroad + kFrame), frame_y, 0}, {kFrame, 0.1, kTall + kFrame}, 0},
                 Material::kWood,
                 0.3);
  }
  scene.AddBox({{x, frame_y, kTall}, {kBroad, 0.1, kFrame}, 0}, Material::kWood, 0.3);
  for (const double z : {0.2, 0.85, 1.45}) {  // raised panels
    for (const double end : {-0.22, 0.22}) {
      scene.AddBox({{x + end, y + side * 0.02, z}, {0.32, 0.03, 0.5}, 0}, Material::kPaint, 0.6);
    }
  }
  scene.AddBox({{x + 0.38, y + side * 0.04, 1.0}, {0.1, 0.06, 0.025}, 0}, Material::kMetal, 0.2);
}

// A window in the wall x = 0 with a frame, a bar and half-lowered blinds.
void AddWindow(SceneBuilder& scene, double y) {
  constexpr double kBroad = 1.5, kTall = 1.2, kSill = 0.95;
  scene.AddBox({{0.01, y, kSill}, {0.02, kBroad, kTall}, 0}, Material::kPaint, 0.95, 0.45);
  for (const double end : {-0.5, 0.0, 0.5}) {
    scene.AddBox({{0.03, y + end * kBroad, kSill}, {0.06, 0.06, kTall}, 0}, Material::kPaint, 0.45);
  }
  for (const double z : {0.0, 1.0}) {
    scene.AddBox(
        {{0.04, y, kSill + z * kTall}, {0.08, kBroad + 0.1, 0.05}, 0}, Material::kWood, 0.4);
  }
  scene.AddLamp(
      {{0.11, y, kSill + 0.5 * kTall}, kBroad * Vector3d::UnitY(), kTall * Vector3d::UnitZ(), 1.0});
  for (int i = 0; i < 9; ++i) {
    scene.AddBox({{0.09, y, kSill + kTall - 0.06 - 0.065 * i}, {0.03, kBroad, 0.018}, 0},
                 Material::kMetal,
                 i % 2 == 0 ? 0.3 : 0.45);
  }
}

void AddPosters(SceneBuilder& scene) {
  struct Sheet {
    double along, z, broad, tall;
    int wall;  // 0: y = 0, 1: x = width, 2: y = depth, 3: x = 0
  };
  const Sheet sheets[] = {{4.6, 1.1, 0.8, 1.1, 0},
                          {5.6, 1.35, 0.5, 0.7, 0},
                          {0.8, 1.2, 0.7, 1.0, 1},
                          {1.8, 1.3, 0.6, 0.8, 1},
                          {4.5, 1.25, 0.7, 0.95, 1},
                          {1.0, 1.2, 0.9, 0.65, 2},
                          {2.1, 1.3, 0.55, 0.8, 2},
                          {0.6, 1.3, 0.5, 0.7, 3},
                          {4.6, 1.15, 0.6, 0.9, 3}};
  for (const Sheet& sheet : sheets) {
    constexpr double kThick = 0.02;
    const bool along_x = sheet.wall % 2 == 0;
    const double off = 0.5 * kThick + 0.002;
    const double across = sheet.wall == 1 ? kWidth - off : sheet.wall == 2 ? kDepth - off : off;
    const Vector3d base =
        along_x ? Vector3d(sheet.along, across, sheet.z) : Vector3d(across, sheet.along, sheet.z);
    const Vector3d size = along_x ? Vector3d(sheet.broad, kThick, sheet.tall)
                                  : Vector3d(kThick, sheet.broad, sheet.tall);
    scene.AddBox({base, size, 0}, Material::kPoster, scene.Random(0.65, 0.95));
  }
}

void AddCeiling(SceneBuilder& scene) {
  constexpr double kLampDrop = 0.3;
  for (const double x : {1.2, 3.2, 5.2}) {  // beams, and lamps between
    scene.AddBox({{x, 0.5 * kDepth, kHeight - 0.16}, {0.12, kDepth - 0.02, 0.155}, 0},
                 Material::kWood,
                 0.35);
    for (const double y : {1.5, 3.6}) {
      const double lamp_x = x - 0.7;
      scene.AddBox(
          {{lamp_x, y, kHeight - kLampDrop}, {0.12, 1.2, 0.06}, 0}, Material::kPaint, 1.0, 1.2);
      scene.AddLamp({{lamp_x, y, kHeight - kLampDrop - 0.01},
                     1.2 * Vector3d::UnitY(),
                     0.12 * Vector3d::UnitX(),
                     x < 2 ? 2.8 : 3.6});
    }
  }
  scene.AddBox(
      {{0.5 * kWidth, kDepth - 0.2, 2.3}, {kWidth - 0.1, 0.14, 0.14}, 0}, Material::kMetal, 0.6);
  scene.AddBox(
      {{kWidth - 0.2, 0.5 * kDepth, 2.05}, {0.1, kDepth - 0.5, 0.1}, 0}, Material::kMetal, 0.45);
}

void AddStacks(SceneBuilder& scene) {
  const Vector3d places[] = {
      {5.85, 4.6, 0}, {5.75, 0.55, 0}, {0.5, 4.7, 0}, {2.9, 4.75, 0}, {0.45, 0.5, 0}};
  for (const Vector3d& place : places) {
    double z = 0;
    const int boxes = 2 + static_cast<int>(scene.Random(0, 2.99));
    for (int i = 0; i < boxes; ++i) {
      const Vector3d size(scene.Random(0.35, 0.55) - 0.04 * i,
                          scene.Random(0.3, 0.5) - 0.04 * i,
                          scene.Random(0.22, 0.4));
      scene.AddBox({place + Vector3d(0, 0, z), size, scene.Random(-0.5, 0.5)},
                   Material::kCardboard,
                   scene.Random(0.35, 0.7));
      z += size.z();
    }
  }
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  scene.AddRoom({kWidth, kDepth, kHeight}, Material::kPlaster, Material::kPlanks);
  scene.AddBox({{3.2, 2.6, 0}, {2.6, 1.7, 0.012}, 0.1}, Material::kCarpet, 0.45);
  AddShelf(scene, 2.9, 0.0, 1, 2.2);
  AddShelf(scene, 4.4, kDepth, -1, 1.6);
  AddDoor(scene, 1.2, 0.0, 1);
  AddWindow(scene, 2.6);
  AddTable(scene, {5.7, 2.6, 0}, 1.8, 0.5 * std::numbers::pi);
  AddTable(scene, {0.75, 2.6, 0}, 1.5, 0.5 * std::numbers::pi);
  AddTable(scene, {1.9, 4.75, 0}, 1.1, 0.0);
  AddPosters(scene);
  AddCeiling(scene);
  AddStacks(scene);
  for (const double y : {1.4, 3.7}) {  // a rail of boards along the brick wall
    scene.AddBox({{kWidth - 0.04, y, 0.9}, {0.05, 1.4, 0.1}, 0}, Material::kWood, 0.7);
  }
  const HandHeldLoop loop({{0.5 * kWidth, 0.5 * kDepth, 1.5}, 1.1, 0.75, 10, seed});
  return {scene.Take(), loop.Path()};
}

}  // namespace room

World MakeRoom(std::uint64_t seed) { return room::Make(seed); }

}  // namespace plumbline
