// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/built_in/furniture.h"
#include "worlds/scene_builder.h"

#include <Eigen/Core>

namespace plumbline {

// Fittings of walls and ceilings. Every place is on the face of the wall and faces the room; its
// base is the middle of the lower side of the fitting.

// The frame around a hole for a door, 7 cm broad on the face of the wall.
void AddDoorFrame(SceneBuilder& scene, const Place& place, const Eigen::Vector2d& hole);

// A closed door in its frame on the face of a wall, with `panels` raised panels and a handle.
struct DoorShape {
  double breadth = 0.9, height = 2.05;
  int panels = 2;  // in each of two columns; 0: a flush door
  double tone = 0.7;
};
void AddDoor(SceneBuilder& scene, const Place& place, const DoorShape& shape);

// An open door leaf: its hinge is at the place, the leaf extends to the front.
void AddOpenLeaf(SceneBuilder& scene, const Place& place, const DoorShape& shape);

// A window of frosted daylight with its frame and sill, which is also a lamp. The pane lies at the
// place, the face of the wall `recess` in front of it.
struct WindowShape {
  double breadth = 1.4, height = 1.3;
  double recess = 0.1;
  int bars = 1;        // upright, between the jambs
  double blinds = 0;   // share of the height covered by slats
  double power = 1;    // of the lamp
  double glow = 0.45;  // of the pane
  int circuit = 0;
};
void AddWindow(SceneBuilder& scene, const Place& place, const WindowShape& shape);

// A ribbed radiator with its pipes; the place is on the floor.
void AddRadiator(SceneBuilder& scene, const Place& place, double length);

// A power socket or light switch, 8 cm wide.
void AddSocket(SceneBuilder& scene, const Place& place);

// A closed channel for cables, `length` along the wall.
void AddDuct(SceneBuilder& scene, const Place& place, double length);

// A curtain in folds, `size` broad and tall, under a rail.
void AddCurtain(SceneBuilder& scene, const Place& place, const Eigen::Vector2d& size, double tone);

// A white board with `columns` x `rows` squares, every other one black.
void AddChecker(SceneBuilder& scene, const Place& place, int columns, int rows, double square);

// A suspended ceiling at z = corner.z(): mineral boards over a grid of metal bars, of which those
// along x are 2 mm lower; a bar lies along each side of the room. Cells start at the corner.
struct CeilingGrid {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Ones();  // along x and y
  double cell = 0.6;
  double tone = 0.75;
};
void AddCeilingGrid(SceneBuilder& scene, const CeilingGrid& grid);

// A lamp replacing `cells_x` x `cells_y` boards of a grid, the first of them at column, row.
struct GridLamp {
  int column = 0, row = 0;
  int cells_x = 1, cells_y = 2;
  double power = 1;
  int circuit = 0;
};
void AddGridLamp(SceneBuilder& scene, const CeilingGrid& grid, const GridLamp& lamp);

}  // namespace plumbline
