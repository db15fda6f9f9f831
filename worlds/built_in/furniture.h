// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/scene_builder.h"

#include <Eigen/Core>

namespace plumbline {

// Pose of a piece of furniture. In its own frame the origin is the middle of its back at the foot,
// x is along it, y to its front, z up: against the wall y = 0 of a room it faces pi / 2, against
// the wall x = 0 it faces 0.
struct Place {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  // world, metres
  double facing = 0;                               // radians, from world x towards y

  double Yaw() const;  // of its x axis
  Eigen::Vector3d At(double x, double y, double z) const;
};

// A box in the frame of a place: `base` is the middle of its bottom face.
void AddPart(
    SceneBuilder& scene, const Place& place, const BoxShape& box, Material material, double tone);

// A table with four legs.
struct TableShape {
  double length = 1.6, breadth = 0.8, height = 0.74;
  Material top = Material::kWood;
  double tone = 0.6;
};
void AddTable(SceneBuilder& scene, const Place& place, const TableShape& shape);

// Adds `count` boxes and small objects spread over a table top.
void AddClutter(SceneBuilder& scene, const Place& place, const TableShape& shape, int count);

// A computer screen on its foot, 0.55 m broad; the place is on the table, and the screen faces its
// front.
void AddScreen(SceneBuilder& scene, const Place& place);

// A desk with `screens` screens, a keyboard, papers and a mug; the seat is at its front.
void AddWorkplace(SceneBuilder& scene, const Place& place, double length, int screens);

// A chair with a padded seat and back on four legs, which faces its front.
void AddChair(SceneBuilder& scene, const Place& place);

// An upright shelf with books, boxes and gaps.
struct ShelfShape {
  double breadth = 1.6, height = 1.95, depth = 0.32;
  int levels = 5;
  double filled = 0.95;  // filled share of the boards
  double tone = 0.5;
};
void AddShelf(SceneBuilder& scene, const Place& place, const ShelfShape& shape);

// A cupboard with two columns of doors or drawers, each with a handle.
void AddCabinet(
    SceneBuilder& scene, const Place& place, const Eigen::Vector3d& size, int rows, double tone);

// A pile of two to four cardboard boxes, about half a metre wide.
void AddStack(SceneBuilder& scene, const Place& place);

// A pot with stems and leaves.
void AddPlant(SceneBuilder& scene, const Place& place, double height);

// A sheet, board or sign on a wall, 1.5 cm thick, its lower side at the place.
void AddSheet(SceneBuilder& scene,
              const Place& place,
              const Eigen::Vector2d& size,
              Material material,
              double tone);

}  // namespace plumbline
