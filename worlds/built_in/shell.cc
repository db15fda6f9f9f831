// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/shell.h"

#include <algorithm>
#include <numbers>

namespace plumbline {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d Along(const Place& place) { return place.At(1, 0, 0) - place.base; }
Vector3d Out(const Place& place) { return place.At(0, 1, 0) - place.base; }

Place ShellShape::Wall(std::size_t k, double along, double height) const {
  const Vector3d corners[] = {
      {0, 0, 0}, {size.x(), 0, 0}, {size.x(), size.y(), 0}, {0, size.y(), 0}};
  const Place corner{corners[k], 0.5 * std::numbers::pi * (1 + static_cast<double>(k))};
  return {corner.At(along, 0, height), corner.facing};
}

void AddShell(SceneBuilder& scene, const ShellShape& shell) {
  const double t = shell.thickness;
  scene.AddFloor(
      {-t, -t, 0}, shell.size.head<2>().array() + 2 * t, shell.floor.material, shell.floor.tone);
  scene.AddCeiling(
      {0, 0, shell.size.z()}, shell.size.head<2>(), shell.ceiling.material, shell.ceiling.tone);
  for (std::size_t k = 0; k < 4; ++k) {
    const Place wall = shell.Wall(k);
    scene.AddWall(
        {wall.At(0, -0.5 * t, 0), wall.At(shell.Length(k), -0.5 * t, 0), shell.size.z(), t},
        shell.openings[k],
        shell.walls[k].material,
        shell.walls[k].tone);
  }
}

void AddSkirting(SceneBuilder& scene, const ShellShape& shell, const Finish& finish) {
  constexpr double kHigh = 0.08, kThick = 0.015;
  constexpr double kFrame = 0.05;  // of doors, which it runs into
  for (std::size_t k = 0; k < 4; ++k) {
    const auto piece = [&](double left, double right) {
      AddPart(scene,
              shell.Wall(k, 0.5 * (left + right)),
              {{0, 0.5 * kThick + 0.001, 0}, {right - left, kThick, kHigh}},
              finish.material,
              finish.tone);
    };
    double left = kThick + 0.003;  // clear of the one around the corner
    for (const Opening& hole : shell.openings[k]) {
      if (hole.bottom > kHigh) continue;
      piece(left, hole.along - kFrame);
      left = hole.along + hole.width + kFrame;
    }
    piece(left, shell.Length(k) - kThick - 0.003);
  }
}

void AddBacking(SceneBuilder& scene,
                const Place& wall,
                const Opening& hole,
                double back,
                const PanelLook& look) {
  scene.AddPanel(wall.At(hole.along + hole.width, -back, hole.bottom),
                 -hole.width * Along(wall),
                 hole.height * Vector3d::UnitZ(),
                 look);
}

void AddViewWindow(SceneBuilder& scene,
                   const Place& wall,
                   const Opening& hole,
                   const ViewShape& shape) {
  constexpr double kBar = 0.06, kDeep = 0.05, kFrame = 0.12, kOutside = 0.19, kPitch = 0.045;
  const double horizon = scene.Random(0.3, 0.5) * hole.height;
  AddBacking(scene,
             wall,
             {hole.along, hole.width, hole.bottom, horizon},
             kOutside,
             {Material::kMural, 0.4, false, shape.glow});
  AddBacking(scene,
             wall,
             {hole.along, hole.width, hole.bottom + horizon, hole.height - horizon},
             kOutside,
             {Material::kBlank, 0.9, false, shape.glow});
  const double middle = hole.along + 0.5 * hole.width;
  const auto part = [&](const Vector3d& base, const Vector3d& size, double tone) {
    AddPart(scene, wall, {base, size}, Material::kPaint, tone);
  };
  for (int i = 0; i <= shape.panes; ++i) {
    const double x = hole.along + 0.5 * kBar + (hole.width - kBar) * i / shape.panes;
    part({x, -kFrame, hole.bottom}, {kBar, kDeep, hole.height}, 0.8);
  }
  for (const double z : {hole.bottom, hole.bottom + hole.height - kBar}) {
    part({middle, -kFrame, z}, {hole.width, kDeep - 0.006, kBar}, 0.8);
  }
  part({middle, 0.04, hole.bottom - 0.037}, {hole.width + 0.12, 0.08, 0.035}, 0.75);  // sill
  for (int i = 0; i < shape.slats; ++i) {
    const double z = hole.bottom + hole.height - 0.05 - kPitch * i;
    if (z < hole.bottom + 0.02) break;
    AddPart(
        scene, wall, {{middle, -0.05, z}, {hole.width - 0.03, 0.03, 0.012}}, Material::kBlank, 0.7);
  }
  scene.AddLamp({wall.At(middle, 0.02, hole.bottom + 0.5 * hole.height),
                 hole.height * Vector3d::UnitZ(),
                 hole.width * Along(wall),
                 shape.power});
}

void AddBarAt(
    SceneBuilder& scene, const Place& place, const BarShape& bar, Material material, double tone) {
  scene.AddBar(place.At(bar.start.x(), bar.start.y(), bar.start.z()),
               place.At(bar.end.x(), bar.end.y(), bar.end.z()),
               bar.thickness,
               material,
               tone);
}

void AddPicture(SceneBuilder& scene, const Place& place, const Vector2d& size, Material material) {
  constexpr double kFrame = 0.03, kProud = 0.025, kSheet = 0.008;
  const double tone = scene.Random(0.15, 0.6);
  const auto bar = [&](double x, double z, double width, double height) {
    AddPart(scene,
            place,
            {{x, 0.5 * kProud + 0.002, z}, {width, kProud, height}},
            Material::kWood,
            tone);
  };
  const double inner = size.x() - 2 * kFrame;
  for (const double side : {-0.5, 0.5}) bar(side * (size.x() - kFrame), 0, kFrame, size.y());
  bar(0, 0, inner, kFrame);
  bar(0, size.y() - kFrame, inner, kFrame);
  const Opening sheet{-0.5 * inner, inner, kFrame, size.y() - 2 * kFrame};
  AddBacking(scene, place, sheet, -kSheet, {material, scene.Random(0.6, 0.9), false});
}

void AddThings(SceneBuilder& scene, const Place& place, double length, double tallest) {
  double x = 0;
  while (x < length - 0.02) {
    const bool book = scene.Random(0, 1) < 0.6;
    const double wide =
        std::min(book ? scene.Random(0.025, 0.06) : scene.Random(0.1, 0.25), length - x);
    const double tall = tallest * scene.Random(book ? 0.6 : 0.3, 0.95);
    AddPart(scene,
            place,
            {{x + 0.5 * wide, 0, 0}, {wide, scene.Random(0.12, 0.2), tall}},
            book ? Material::kSpine : Material::kCardboard,
            scene.Random(0.15, 0.9));
    x += wide + (scene.Random(0, 1) < 0.2 ? scene.Random(0.03, 0.15) : 0.003);
  }
}

void AddTubeLamp(SceneBuilder& scene, const Place& place, const TubeShape& tube) {
  constexpr double kHigh = 0.06, kWide = 0.16, kTube = 0.045, kGlow = 1.3;
  const Vector3d along = tube.length * Along(place);
  AddPart(scene, place, {{0, 0, 0}, {tube.length, kWide, kHigh}}, Material::kBlank, 0.8);
  for (const double side : {-0.04, 0.04}) {
    scene.AddPanel(place.At(-0.5 * tube.length, side - 0.5 * kTube, -0.004),
                   kTube * Out(place),
                   along,
                   {Material::kBlank, 0.95, true, kGlow, tube.circuit});
  }
  scene.AddLamp({place.At(0, 0, -0.012), kWide * Out(place), along, tube.power, tube.circuit});
}

}  // namespace plumbline
