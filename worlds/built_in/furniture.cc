// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/furniture.h"

#include "plumbline/base/elementary.h"

#include <cmath>
#include <numbers>

namespace plumbline {

using Eigen::Vector3d;

double Place::Yaw() const { return facing - 0.5 * std::numbers::pi; }

Vector3d Place::At(double x, double y, double z) const {
  const double c = math::Cos(Yaw()), s = math::Sin(Yaw());
  return base + Vector3d(c * x - s * y, s * x + c * y, z);
}

void AddPart(
    SceneBuilder& scene, const Place& place, const BoxShape& box, Material material, double tone) {
  scene.AddBox(
      {place.At(box.base.x(), box.base.y(), box.base.z()), box.size, place.Yaw() + box.yaw},
      material,
      tone);
}

void AddTable(SceneBuilder& scene, const Place& place, const TableShape& shape) {
  constexpr double kThick = 0.035, kLeg = 0.05, kInset = 0.04;
  const double middle = 0.5 * shape.breadth, under = shape.height - kThick;
  AddPart(scene,
          place,
          {{0, middle, under}, {shape.length, shape.breadth, kThick}},
          shape.top,
          shape.tone);
  const double x = 0.5 * (shape.length - kLeg) - kInset, y = middle - 0.5 * kLeg - kInset;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) {
      AddPart(scene,
              place,
              {{side * x, middle + end * y, 0}, {kLeg, kLeg, under}},
              Material::kMetal,
              0.35);
    }
    AddPart(scene,  // rails under the top
            place,
            {{side * x, middle, under - 0.06}, {0.03, 2 * y - kLeg, 0.05}},
            Material::kMetal,
            0.35);
  }
}

void AddClutter(SceneBuilder& scene, const Place& place, const TableShape& shape, int count) {
  constexpr Material kMaterials[] = {
      Material::kCardboard, Material::kPoster, Material::kSpine, Material::kMetal};
  const double pitch = shape.length / count;
  for (int i = 0; i < count; ++i) {
    // Each keeps to its own strip of the table whatever its turn.
    const double most = std::min(0.7 * pitch, 0.3);
    const Vector3d size(scene.Random(0.5, 1) * most,
                        scene.Random(0.08, 0.25),
                        i % 3 == 2 ? scene.Random(0.02, 0.05) : scene.Random(0.08, 0.32));
    const double x = shape.length * (-0.5 + (i + 0.5) / count);
    const double y = shape.breadth * scene.Random(0.3, 0.65);
    const double turn = scene.Random(-0.3, 0.3);
    AddPart(scene,
            place,
            {{x, y, shape.height}, size, turn},
            kMaterials[static_cast<int>(scene.Random(0, 3.999))],
            scene.Random(0.2, 0.9));
  }
}

void AddScreen(SceneBuilder& scene, const Place& place) {
  constexpr double kBroad = 0.55, kTall = 0.33, kDeep = 0.035, kRaised = 0.14, kRim = 0.012;
  AddPart(scene, place, {{0, 0.1, 0}, {0.24, 0.18, 0.012}}, Material::kPaint, 0.15);
  AddPart(scene, place, {{0, 0.06, 0.012}, {0.05, 0.03, 0.25}}, Material::kPaint, 0.15);
  AddPart(scene, place, {{0, 0.1, kRaised}, {kBroad, kDeep, kTall}}, Material::kPaint, 0.12);
  const Vector3d across = place.At(1, 0, 0) - place.base;
  const Vector3d corner = place.At(0.5 * kBroad - kRim, 0.1 + 0.5 * kDeep + 0.002, kRaised + kRim);
  scene.AddPanel(corner,
                 -(kBroad - 2 * kRim) * across,
                 (kTall - 2 * kRim) * Vector3d::UnitZ(),
                 {Material::kScreen, scene.Random(0.35, 0.75), true, 0.45});
}

void AddWorkplace(SceneBuilder& scene, const Place& place, double length, int screens) {
  TableShape desk;
  desk.length = length;
  desk.tone = scene.Random(0.5, 0.75);
  AddTable(scene, place, desk);
  for (int i = 0; i < screens; ++i) {
    const double x = (i - 0.5 * (screens - 1)) * 0.6;
    AddScreen(scene, {place.At(x, 0.12, desk.height), place.facing - 0.25 * x});
  }
  const double top = desk.height;
  const double key_x = scene.Random(-0.08, 0.08);
  AddPart(scene, place, {{key_x, 0.55, top}, {0.43, 0.14, 0.018}, 0.05}, Material::kScreen, 0.3);
  AddPart(scene, place, {{key_x - 0.32, 0.55, top}, {0.06, 0.1, 0.03}, 0.2}, Material::kPaint, 0.2);
  const double end = 0.5 * length;
  AddPart(scene,
          place,
          {{end - 0.17, 0.55, top}, {0.21, 0.297, 0.006 + scene.Random(0, 0.04)}, 0.15},
          Material::kPoster,
          0.9);
  AddPart(scene,
          place,
          {{0.17 - end, scene.Random(0.45, 0.65), top}, {0.075, 0.075, 0.1}, 0.6},
          Material::kPaint,
          scene.Random(0.2, 0.9));
  AddPart(scene,
          place,
          {{0.16 - end, 0.2, top}, {0.25, 0.28, scene.Random(0.1, 0.3)}},
          Material::kCardboard,
          scene.Random(0.3, 0.8));
}

void AddChair(SceneBuilder& scene, const Place& place) {
  constexpr double kSeat = 0.45, kPad = 0.06, kSide = 0.46, kLeg = 0.035;
  const double tone = scene.Random(0.2, 0.6), middle = 0.5 * kSide;
  AddPart(scene, place, {{0, middle, kSeat}, {kSide, kSide, kPad}}, Material::kFabric, tone);
  AddPart(scene, place, {{0, 0.0, 0.62}, {0.44, 0.05, 0.36}}, Material::kFabric, tone);
  for (const double side : {-1.0, 1.0}) {
    const double x = side * (middle - 0.5 * kLeg - 0.01);
    AddPart(scene, place, {{x, kSide - 0.03, 0}, {kLeg, kLeg, kSeat}}, Material::kMetal, 0.3);
    AddPart(scene, place, {{x, -0.045, 0}, {kLeg, kLeg, 0.95}}, Material::kMetal, 0.3);
    AddPart(scene, place, {{x, 0.2, 0.2}, {0.02, 0.44, 0.02}}, Material::kMetal, 0.3);
  }
}

namespace {

// A book or box on a board, without the faces hidden by the shelf, back and bottom. The place is
// the middle of its back at the foot.
void AddBook(SceneBuilder& scene, const Place& place, const Vector3d& size, bool box) {
  const double tone = scene.Random(0.1, 0.95), half = 0.5 * size.x();
  const Vector3d x = place.At(1, 0, 0) - place.base, y = place.At(0, 1, 0) - place.base;
  const Vector3d across = -size.x() * x, deep = size.y() * y, up = size.z() * Vector3d::UnitZ();
  const Vector3d front = place.At(half, size.y(), 0);
  const Material cover = box ? Material::kCardboard : Material::kPaint;
  scene.AddPanel(front, across, up, {box ? cover : Material::kSpine, tone, true});
  scene.AddPanel(front - deep, deep, up, {cover, tone, false});     // looks along x
  scene.AddPanel(front + across, -deep, up, {cover, tone, false});  // looks along -x
  scene.AddPanel(front + up, across, -deep, {cover, box ? tone : 0.75, false});
  for (const Vector3d& side : {Vector3d::Zero().eval(), across}) {
    scene.AddEdge(front + up + side, front + up + side - deep);
  }
  scene.AddEdge(front + up - deep, front + up - deep + across);
}

}  // namespace

void AddShelf(SceneBuilder& scene, const Place& place, const ShelfShape& shape) {
  constexpr double kBoard = 0.025, kPlinth = 0.06;
  const double y = 0.5 * shape.depth + 0.004, half = 0.5 * shape.breadth;
  for (const double end : {-1.0, 1.0}) {
    AddPart(scene,
            place,
            {{end * half, y, 0}, {kBoard, shape.depth, shape.height}},
            Material::kWood,
            shape.tone);
  }
  const double pitch = (shape.height - kPlinth - 0.05) / shape.levels;
  for (int level = 0; level <= shape.levels; ++level) {
    const double z = kPlinth + level * pitch;
    AddPart(scene,
            place,
            {{0, y, z}, {shape.breadth - kBoard, shape.depth - 0.006, kBoard}},
            Material::kWood,
            shape.tone + 0.05);
    if (level == shape.levels) break;
    const double room = pitch - kBoard - 0.02;
    double left = -half + 0.03;
    while (left < half - 0.1) {
      if (scene.Random(0, 1) > shape.filled) left += scene.Random(0.05, 0.3);
      const bool box = scene.Random(0, 1) < 0.12;
      const double wide = box ? scene.Random(0.14, 0.26) : scene.Random(0.03, 0.08);
      if (left + wide > half - 0.03) break;
      const double deep = scene.Random(0.55, 0.8) * shape.depth;
      const double back = 0.5 * (shape.depth - deep);
      AddBook(scene,
              {place.At(left + 0.5 * wide, back, z + kBoard), place.facing},
              {wide, deep, scene.Random(0.62, 0.95) * room},
              box);
      left += wide + 0.003;
    }
  }
}

void AddCabinet(
    SceneBuilder& scene, const Place& place, const Vector3d& size, int rows, double tone) {
  constexpr double kGap = 0.006, kFront = 0.018;
  AddPart(scene, place, {{0, 0.5 * size.y() + 0.004, 0}, size}, Material::kBlank, 0.6 * tone);
  const double tall = (size.z() - 0.08) / rows, wide = 0.5 * size.x();
  for (int row = 0; row < rows; ++row) {
    for (const double side : {-0.5, 0.5}) {
      const double y = size.y() + 0.004 + 0.5 * kFront, z = 0.07 + row * tall;
      AddPart(scene,
              place,
              {{side * wide, y, z}, {wide - kGap, kFront, tall - kGap}},
              Material::kBlank,
              tone);
      const double handle_x = side * wide - (side < 0 ? -1 : 1) * (0.5 * wide - 0.06);
      AddPart(scene,
              place,
              {{rows > 2 ? side * wide : handle_x, y + 0.02, z + 0.5 * tall},
               rows > 2 ? Vector3d(0.12, 0.022, 0.015) : Vector3d(0.015, 0.022, 0.14)},
              Material::kMetal,
              0.3);
    }
  }
}

void AddStack(SceneBuilder& scene, const Place& place) {
  double z = 0;
  const int boxes = 2 + static_cast<int>(scene.Random(0, 2.99));
  for (int i = 0; i < boxes; ++i) {
    const Vector3d size(scene.Random(0.35, 0.5) - 0.03 * i,
                        scene.Random(0.3, 0.45) - 0.03 * i,
                        scene.Random(0.22, 0.4));
    AddPart(scene,
            place,
            {{0, 0.35, z}, size, scene.Random(-0.25, 0.25)},
            Material::kCardboard,
            scene.Random(0.35, 0.7));
    z += size.z();
  }
}

void AddPlant(SceneBuilder& scene, const Place& place, double height) {
  constexpr double kPot = 0.3;
  const Vector3d foot = place.At(0, 0.25, 0);
  scene.AddPrism(foot, foot + Vector3d(0, 0, kPot), {0.16, 6}, Material::kPaint, 0.6);
  for (int i = 0; i < 9; ++i) {
    const double turn = 2.4 * i + scene.Random(-0.3, 0.3);
    const double reach = scene.Random(0.08, 0.3), top = height * scene.Random(0.55, 1);
    const Vector3d out(math::Cos(turn), math::Sin(turn), 0);
    const Vector3d stem = foot + 0.08 * out + Vector3d(0, 0, kPot - 0.05);
    const Vector3d tip = foot + reach * out + Vector3d(0, 0, top);
    scene.AddBar(stem, tip, 0.014, Material::kWood, 0.4);
    for (int k = 0; k < 3; ++k) {  // leaves along the stem
      const Vector3d at = tip - 0.17 * k * (tip - stem);
      const double swing = turn + scene.Random(-1.2, 1.2);
      const Eigen::Quaterniond attitude =
          ExpSo3(swing * Vector3d::UnitZ()) * ExpSo3(scene.Random(0.1, 0.7) * Vector3d::UnitY());
      const Vector3d along = attitude * Vector3d::UnitX();
      scene.AddPlacedBox({attitude, at + 0.09 * along},
                         {0.2, 0.06, 0.004},
                         Material::kFabric,
                         scene.Random(0.25, 0.5));
    }
  }
}

void AddSheet(SceneBuilder& scene,
              const Place& place,
              const Eigen::Vector2d& size,
              Material material,
              double tone) {
  constexpr double kThick = 0.015, kOff = 0.003;
  AddPart(
      scene, place, {{0, kOff + 0.5 * kThick, 0}, {size.x(), kThick, size.y()}}, material, tone);
}

}  // namespace plumbline
