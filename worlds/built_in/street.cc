// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/street.h"

#include "worlds/built_in/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStorey = 2.9;

// Appearance of a house, the same for all its windows.
struct HouseLook {
  Material wall = Material::kPlaster;
  double wall_tone = 0.5;
  double frame_tone = 0.8;
  Vector2d window = {1.2, 1.4};
  double roof_tone = 0.3;
  bool pitched = false;
};

HouseLook RandomLook(SceneBuilder& scene) {
  constexpr std::array kWalls = {Material::kPlaster,
                                 Material::kPlaster,
                                 Material::kBrick,
                                 Material::kBrick,
                                 Material::kPaint,
                                 Material::kPlanks};
  HouseLook look;
  look.wall = kWalls[static_cast<std::size_t>(scene.Random(0, kWalls.size() - 0.01))];
  look.wall_tone = scene.Random(0.28, 0.55);
  look.frame_tone = scene.Random(0, 1) < 0.7 ? scene.Random(0.6, 0.8) : scene.Random(0.15, 0.25);
  look.window = {scene.Random(0.95, 1.6), scene.Random(1.2, 1.6)};
  look.roof_tone = scene.Random(0.15, 0.3);
  look.pitched = scene.Random(0, 1) < 0.5;
  return look;
}

// A frame that stands out from the wall, with two panes; the place is the middle of its lower side.
void AddHouseWindow(SceneBuilder& scene, const Place& place, const HouseLook& look) {
  constexpr double kDeep = 0.05, kRim = 0.08, kBefore = 0.004;
  const double b = look.window.x(), h = look.window.y();
  AddPart(scene, place, {{0, 0.5 * kDeep, 0}, {b, kDeep, h}}, Material::kBlank, look.frame_tone);
  const bool curtains = scene.Random(0, 1) < 0.3;
  for (const double side : {-1.0, 1.0}) {
    const double width = 0.5 * b - 1.5 * kRim;
    const double middle = 0.5 * side * (width + kRim);
    scene.AddPanel(place.At(middle + 0.5 * width, kDeep + kBefore, kRim),
                   -width * Along(place),
                   (h - 2 * kRim) * Vector3d::UnitZ(),
                   {curtains ? Material::kFabric : Material::kPaint,
                    curtains ? scene.Random(0.25, 0.5) : scene.Random(0.05, 0.16),
                    true});
  }
}

void AddFrontDoor(SceneBuilder& scene, const Place& place, const HouseLook& look) {
  AddPart(scene, place, {{0, 0.06, 0}, {1.4, 0.12, 2.45}}, Material::kConcrete, 0.6);
  AddPart(scene, place, {{0, 0.13, 0.1}, {1.0, 0.06, 2.15}}, Material::kWood, look.roof_tone);
  AddPart(scene, place, {{0, 0.5, 0}, {1.6, 1.0, 0.1}}, Material::kConcrete, 0.5);
}

void AddRoof(SceneBuilder& scene,
             const Place& place,
             const HouseShape& shape,
             const HouseLook& look) {
  const double eaves = shape.storeys * kStorey, over = 0.35;
  AddPart(scene,  // the cornice
          place,
          {{0, -0.5 * shape.depth, eaves}, {shape.length - 0.004, shape.depth + 2 * over, 0.28}},
          Material::kPaint,
          look.frame_tone);
  if (!look.pitched) return;
  const double rise = scene.Random(1.8, 3), half = 0.5 * shape.depth;
  AddPart(scene,
          place,
          {{0, -half, eaves + 0.28}, {shape.length - 0.01, shape.depth * 0.45, 0.5 * rise}},
          look.wall,
          look.wall_tone);
  const Vector3d along = shape.length * Along(place);
  const double foot = eaves + 0.285;
  for (const double side : {-1.0, 1.0}) {
    const Vector3d low = place.At(-0.5 * shape.length, -half + side * (half + over), foot);
    const Vector3d up = place.At(-0.5 * shape.length, -half, foot + rise) - low;
    scene.AddPanel(low, along, up, {Material::kPlanks, look.roof_tone, true});
  }
  AddPart(scene,
          place,
          {{scene.Random(-0.35, 0.35) * shape.length, -half, foot + 0.6 * rise}, {0.6, 0.6, 1.6}},
          Material::kBrick,
          0.35);
}

}  // namespace

void AddHouse(SceneBuilder& scene, const Place& place, const HouseShape& shape) {
  const HouseLook look = RandomLook(scene);
  const double height = shape.storeys * kStorey;
  AddPart(scene,
          place,
          {{0, -0.5 * shape.depth, 0}, {shape.length, shape.depth, height}},
          look.wall,
          look.wall_tone);
  AddPart(scene,  // the plinth
          place,
          {{0, 0.02, 0}, {shape.length - 0.02, 0.04, scene.Random(0.35, 0.7)}},
          Material::kConcrete,
          scene.Random(0.25, 0.45));
  AddRoof(scene, place, shape, look);
  const int columns = std::max(1, static_cast<int>((shape.length - 1) / scene.Random(2.4, 3.4)));
  const double step = shape.length / columns;
  const int door = static_cast<int>(scene.Random(0, columns - 0.01));
  for (int storey = 0; storey < shape.storeys; ++storey) {
    for (int column = 0; column < columns; ++column) {
      const double x = (column + 0.5) * step - 0.5 * shape.length;
      if (storey == 0 && column == door) {
        AddFrontDoor(scene, {place.At(x, 0, 0), place.facing}, look);
      } else {
        AddHouseWindow(scene, {place.At(x, 0, storey * kStorey + 0.95), place.facing}, look);
      }
    }
  }
}

void AddCar(SceneBuilder& scene, const Place& place) {
  const double paint = scene.Random(0, 1) < 0.4 ? scene.Random(0.5, 0.75) : scene.Random(0.08, 0.4);
  const double length = scene.Random(3.8, 4.6), roof = scene.Random(0.5, 0.85);
  const double back = scene.Random(-0.5, 0.1);
  const auto part = [&](const Vector3d& base, const Vector3d& size, double tone) {
    AddPart(scene, place, {base, size}, Material::kPaint, tone);
  };
  part({0, 0, 0.28}, {length, 1.7, 0.62}, paint);
  part({back, 0, 0.9}, {0.55 * length, 1.5, roof}, 0.1);  // glass
  for (const double at : {-0.5, 0.0, 0.5}) {              // and what is between
    part({back + at * (0.55 * length - 0.06), 0, 0.9}, {0.1, 1.53, roof}, paint);
  }
  part({back, 0, 0.9 + roof}, {0.55 * length + 0.06, 1.53, 0.06}, paint);
  for (const double axle : {-0.31, 0.31}) {
    part({axle * length, 0, 0.002}, {0.62, 1.76, 0.6}, 0.05);
  }
  part({0, 0, 0.36}, {length + 0.1, 1.72, 0.1}, 0.15);
  part({0, 0, 0.55}, {length + 0.06, 0.5, 0.11}, 0.7);  // number plates
}

void AddTree(SceneBuilder& scene, const Vector3d& foot) {
  constexpr int kPanels = 9;
  const double stem = scene.Random(1.9, 2.8), crown = scene.Random(1.1, 1.7);
  const Vector3d lean(scene.Random(-0.15, 0.15), scene.Random(-0.15, 0.15), stem + 0.5);
  scene.AddBar(foot, foot + lean, scene.Random(0.16, 0.32), Material::kWood, 0.25);
  const Vector3d middle = foot + Vector3d(0, 0, stem + 0.8 * crown);
  for (int i = 0; i < kPanels; ++i) {
    const Vector3d turn(scene.Random(-3, 3), scene.Random(-3, 3), scene.Random(-3, 3));
    const Eigen::Quaterniond rotation = ExpSo3(turn);
    const Vector3d u = rotation * Vector3d(scene.Random(0.8, 1.5) * crown, 0, 0);
    const Vector3d v = rotation * Vector3d(0, scene.Random(0.6, 1.2) * crown, 0);
    const Vector3d at(scene.Random(-0.5, 0.5), scene.Random(-0.5, 0.5), scene.Random(-0.45, 0.6));
    scene.AddPanel(middle + crown * at - 0.5 * (u + v),
                   u,
                   v,
                   {Material::kMural, scene.Random(0.15, 0.32), false});
  }
}

void AddLampPost(SceneBuilder& scene, const Place& place) {
  const double tall = scene.Random(4.5, 6);
  AddBarAt(scene, place, {{0, 0, 0}, {0, 0, tall}, 0.13}, Material::kMetal, 0.45);
  AddBarAt(
      scene, place, {{0, 0.07, tall - 0.1}, {0, 1.3, tall - 0.02}, 0.1}, Material::kMetal, 0.5);
}

}  // namespace plumbline
