// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/built_in/furniture.h"
#include "worlds/scene_builder.h"

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

struct Finish {
  Material material = Material::kPaint;
  double tone = 0.5;
};

// A rectangular room with a corner of its floor at the origin. Wall k goes from corner k to the
// next, counterclockwise: y = 0, x = size.x, y = size.y, x = 0; its holes are counted from corner
// k.
struct ShellShape {
  Eigen::Vector3d size = {6, 5, 2.8};
  double thickness = 0.24;  // of the walls, outside of the size
  std::array<Finish, 4> walls;
  Finish floor, ceiling;
  std::array<std::vector<Opening>, 4> openings;

  double Length(std::size_t k) const { return k % 2 == 0 ? size.x() : size.y(); }
  // A place on the inner face of wall k, `along` from corner k and `height` over the floor; it
  // faces the room.
  Place Wall(std::size_t k, double along = 0, double height = 0) const;
};

// Adds floor, ceiling and the four walls with their holes. The floor continues through the doors.
void AddShell(SceneBuilder& scene, const ShellShape& shell);

// Adds a board along the foot of every wall, except at holes that reach the floor.
void AddSkirting(SceneBuilder& scene, const ShellShape& shell, const Finish& finish);

// A panel that closes a hole of a wall at its far side, `back` behind the face of the place; `hole`
// is given in the frame of the place.
void AddBacking(SceneBuilder& scene,
                const Place& wall,
                const Opening& hole,
                double back,
                const PanelLook& look);

// A window in a hole of a wall, with sky over trees outside, which is also a lamp; `hole` as above.
// Walls must be at least 0.2 m thick.
struct ViewShape {
  int panes = 2;       // side by side
  double power = 1.5;  // of the lamp
  double glow = 0.4;   // of the view outside
  int slats = 0;       // of a blind, from the top down
};
void AddViewWindow(SceneBuilder& scene,
                   const Place& wall,
                   const Opening& hole,
                   const ViewShape& shape);

// Directions of the axes of a place.
Eigen::Vector3d Along(const Place& place);
Eigen::Vector3d Out(const Place& place);

// A bar of square section in the frame of a place.
struct BarShape {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::UnitX();
  double thickness = 0.02;
};
void AddBarAt(
    SceneBuilder& scene, const Place& place, const BarShape& bar, Material material, double tone);

// A sheet in a frame on a wall; the place is the middle of its lower rim.
void AddPicture(SceneBuilder& scene,
                const Place& place,
                const Eigen::Vector2d& size,
                Material material);

// Adds a row of objects on a board, up to `tallest` high: books, boxes, gaps. It starts at the
// place and goes along it for `length`; the middle of the objects is on its x axis.
void AddThings(SceneBuilder& scene, const Place& place, double length, double tallest);

// A pair of bare tubes under a housing; the place is the middle of the housing's lower side, the
// lamp is along its x.
struct TubeShape {
  double length = 1.2;
  double power = 1.0;
  int circuit = 0;
};
void AddTubeLamp(SceneBuilder& scene, const Place& place, const TubeShape& tube);

}  // namespace plumbline
