// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/fittings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {

using Eigen::Vector2d;
using Eigen::Vector3d;

void AddDoorFrame(SceneBuilder& scene, const Place& place, const Vector2d& hole) {
  constexpr double kBroad = 0.07, kThick = 0.024, kTone = 0.3;
  for (const double side : {-0.5, 0.5}) {
    AddPart(scene,
            place,
            {{side * (hole.x() + kBroad), 0.5 * kThick, 0}, {kBroad, kThick, hole.y() + kBroad}},
            Material::kBlank,
            kTone);
  }
  AddPart(scene,
          place,
          {{0, 0.5 * kThick, hole.y()}, {hole.x(), kThick - 0.004, kBroad}},
          Material::kBlank,
          kTone);
}

namespace {

// A leaf whose middle is at the place, its faces at +-2 cm, with the handles of both sides.
void AddLeaf(SceneBuilder& scene, const Place& place, const DoorShape& shape, bool both_sides) {
  constexpr double kThick = 0.04, kRaised = 0.02;
  AddPart(scene,
          place,
          {{0, 0, 0.006}, {shape.breadth - 0.008, kThick, shape.height - 0.01}},
          Material::kBlank,
          shape.tone);
  const double tall = shape.panels > 0 ? (shape.height - 0.15) / shape.panels : 0;
  for (const double face : {1.0, -1.0}) {
    if (face < 0 && !both_sides) break;
    for (int i = 0; i < shape.panels; ++i) {
      for (const double side : {-0.235, 0.235}) {
        AddPart(scene,
                place,
                {{side * shape.breadth, face * 0.5 * kThick, 0.15 + i * tall},
                 {0.34 * shape.breadth, kRaised, tall - 0.13}},
                Material::kBlank,
                0.9 * shape.tone);
      }
    }
    const double x = 0.5 * shape.breadth - 0.07;
    AddPart(scene,
            place,
            {{x, face * (0.5 * kThick + 0.004), 0.95}, {0.035, 0.008, 0.2}},
            Material::kMetal,
            0.4);
    AddPart(scene,
            place,
            {{x - 0.04, face * (0.5 * kThick + 0.05), 1.05}, {0.12, 0.02, 0.02}},
            Material::kMetal,
            0.25);
  }
}

}  // namespace

void AddDoor(SceneBuilder& scene, const Place& place, const DoorShape& shape) {
  AddDoorFrame(scene, place, {shape.breadth, shape.height});
  AddLeaf(scene, {place.At(0, -0.01, 0), place.facing}, shape, false);
}

void AddOpenLeaf(SceneBuilder& scene, const Place& place, const DoorShape& shape) {
  const double turn = place.facing + 0.5 * std::numbers::pi;  // the leaf lies along the front
  AddLeaf(scene, {place.At(0, 0.5 * shape.breadth, 0), turn}, shape, true);
}

void AddWindow(SceneBuilder& scene, const Place& place, const WindowShape& shape) {
  constexpr double kBar = 0.05, kDeep = 0.06, kPane = 0.012, kTone = 0.7;
  const double b = shape.breadth, h = shape.height;
  const Vector3d x = place.At(1, 0, 0) - place.base, up = Vector3d::UnitZ();
  scene.AddPanel(place.At(0.5 * b, kPane, 0),
                 -b * x,
                 h * up,
                 {Material::kBlank, 0.95, false, shape.glow, shape.circuit});
  const double deep = kPane + 0.5 * kDeep;
  for (int i = 0; i <= shape.bars + 1; ++i) {
    const double at = (b - kBar) * (static_cast<double>(i) / (shape.bars + 1) - 0.5);
    AddPart(scene, place, {{at, deep, 0}, {kBar, kDeep, h}}, Material::kBlank, kTone);
  }
  for (const double z : {0.0, h - kBar}) {
    AddPart(scene, place, {{0, deep, z}, {b, kDeep - 0.006, kBar}}, Material::kBlank, kTone);
  }
  AddPart(scene,  // the sill stands out from the wall
          place,
          {{0, 0.5 * (shape.recess + 0.07), -0.028}, {b + 0.1, shape.recess + 0.07, 0.025}},
          Material::kWood,
          0.6);
  constexpr double kSlat = 0.05;
  const int slats = static_cast<int>(shape.blinds * h / kSlat);
  for (int i = 0; i < slats; ++i) {
    AddPart(scene,
            place,
            {{0, kPane + kDeep + 0.02, h - 0.05 - i * kSlat}, {b - 0.02, 0.025, 0.03}},
            Material::kBlank,
            i % 2 == 0 ? 0.55 : 0.65);
  }
  const double before = std::max(shape.recess, kPane + kDeep + 0.05) + 0.01;
  scene.AddLamp({place.At(0, before, 0.5 * h), -b * x, h * up, shape.power, shape.circuit});
}

void AddRadiator(SceneBuilder& scene, const Place& place, double length) {
  constexpr double kFoot = 0.12, kTall = 0.6, kRib = 0.05;
  AddPart(scene, place, {{0, 0.06, kFoot}, {length, 0.04, kTall}}, Material::kBlank, 0.75);
  const int ribs = static_cast<int>(length / (2 * kRib));
  for (int i = 0; i < ribs; ++i) {
    const double x = length * ((i + 0.5) / ribs - 0.5);
    AddPart(
        scene, place, {{x, 0.09, kFoot + 0.03}, {kRib, 0.03, kTall - 0.06}}, Material::kBlank, 0.8);
  }
  for (const double dx : {0.05, 0.1}) {
    AddPart(scene,
            place,
            {{0.5 * length + dx, 0.05, 0}, {0.02, 0.02, kFoot + 0.2}},
            Material::kBlank,
            0.7);
  }
}

void AddSocket(SceneBuilder& scene, const Place& place) {
  AddPart(scene, place, {{0, 0.006, 0}, {0.08, 0.012, 0.08}}, Material::kBlank, 0.85);
  AddPart(scene, place, {{0, 0.012, 0.015}, {0.05, 0.006, 0.05}}, Material::kBlank, 0.6);
}

void AddDuct(SceneBuilder& scene, const Place& place, double length) {
  AddPart(scene, place, {{0, 0.03, 0}, {length, 0.054, 0.11}}, Material::kBlank, 0.65);
}

void AddCurtain(SceneBuilder& scene, const Place& place, const Vector2d& size, double tone) {
  constexpr double kFold = 0.13, kNear = 0.04, kFar = 0.13;
  const int folds = std::max(2, static_cast<int>(size.x() / kFold));
  const Vector3d up = size.y() * Vector3d::UnitZ();
  // From its own right end to the left, so that the cloth is lit on the side of the room.
  const auto crease = [&](int i, double jitter) -> Vector3d {
    const double x = size.x() * (0.5 - static_cast<double>(i) / folds);
    return place.At(x, (i % 2 == 0 ? kNear : kFar) + jitter, 0);
  };
  Vector3d last = crease(0, 0);
  scene.AddEdge(last, last + up);
  for (int i = 1; i <= folds; ++i) {
    const Vector3d next = crease(i, scene.Random(-0.02, 0.02));
    scene.AddPanel(last, next - last, up, {Material::kFabric, tone, false});
    scene.AddEdge(next, next + up);
    scene.AddEdge(last, next);
    last = next;
  }
  AddPart(scene,
          place,
          {{0, 0.085, size.y() - 0.04}, {size.x() + 0.2, 0.17, 0.08}},
          Material::kBlank,
          0.6);
}

void AddChecker(SceneBuilder& scene, const Place& place, int columns, int rows, double square) {
  constexpr double kFace = 0.018, kBefore = 0.003;
  const double margin = 0.6 * square;
  AddSheet(scene,
           place,
           {columns * square + 2 * margin, rows * square + 2 * margin},
           Material::kBlank,
           0.85);
  const Vector3d u = -square * (place.At(1, 0, 0) - place.base);
  for (int row = 0; row < rows; ++row) {
    for (int column = row % 2; column < columns; column += 2) {
      const Vector3d corner =
          place.At((0.5 * columns - column) * square, kFace + kBefore, margin + row * square);
      scene.AddPanel(corner, u, square * Vector3d::UnitZ(), {Material::kBlank, 0.06});
    }
  }
}

void AddCeilingGrid(SceneBuilder& scene, const CeilingGrid& grid) {
  constexpr double kBar = 0.024, kDrop = 0.008, kStep = 0.002;
  const Vector3d corner = grid.corner;
  scene.AddCeiling(corner, grid.size, Material::kAcoustic, grid.tone);
  const auto bars = [&grid](double length) {
    return static_cast<int>(std::ceil(length / grid.cell - 0.1));
  };
  const auto at = [&grid](int i, double length) {
    return std::clamp(i * grid.cell, 0.5 * kBar, length - 0.5 * kBar);
  };
  for (int i = 0; i <= bars(grid.size.y()); ++i) {
    const Vector3d base = corner + Vector3d(0.5 * grid.size.x(), at(i, grid.size.y()), 0);
    scene.AddBox({base - Vector3d(0, 0, kDrop + kStep), {grid.size.x(), kBar, kDrop + kStep}},
                 Material::kBlank,
                 0.85);
  }
  for (int i = 0; i <= bars(grid.size.x()); ++i) {
    const Vector3d base = corner + Vector3d(at(i, grid.size.x()), 0.5 * grid.size.y(), 0);
    scene.AddBox(
        {base - Vector3d(0, 0, kDrop), {kBar, grid.size.y(), kDrop}}, Material::kBlank, 0.85);
  }
}

void AddGridLamp(SceneBuilder& scene, const CeilingGrid& grid, const GridLamp& lamp) {
  constexpr double kRim = 0.03, kBelow = 0.015;
  const Vector2d size = grid.cell * Vector2d(lamp.cells_x, lamp.cells_y);
  const Vector2d middle = grid.cell * Vector2d(lamp.column, lamp.row) + 0.5 * size;
  const Vector3d centre = grid.corner + Vector3d(middle.x(), middle.y(), -kBelow);
  scene.AddCeilingLamp(centre, size - Vector2d(kRim, kRim), lamp.power, lamp.circuit);
}

}  // namespace plumbline
