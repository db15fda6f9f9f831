// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/built_in/fittings.h"
#include "worlds/path.h"
#include "worlds/scene_builder.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The inside of a room of a building, floor at z = 0: a rectangle of the plan. Neighbours are a
// wall's thickness apart.
struct RoomPlan {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Ones();
  double height = 2.7;
  Material wall = Material::kPaint;
  double wall_tone = 0.7;
  Material floor = Material::kCarpet;
  double floor_tone = 0.4;
  double skirting = 0.08;  // height; 0: none
  bool grid = true;        // true: a suspended ceiling in a grid of 0.6 m; false: a plain one

  CeilingGrid Ceiling() const;
};

// A hole through a wall: a rectangle of the plan, between two heights. It belongs to each room that
// it touches with a whole side: two rooms are connected, a single one gets a niche for a window. A
// hole without depth connects adjoining rooms. `frame`: a door frame on each face.
struct Passage {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double bottom = 0;
  double top = 2.05;
  bool frame = true;
};

// Adds walls with their holes, floors, ceilings, skirtings, and the edges between them.
void AddBuilding(SceneBuilder& scene,
                 std::span<const RoomPlan> rooms,
                 std::span<const Passage> passages);

// A straight leg of a walk: its end and the walker's viewing direction.
struct Leg {
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double gaze = 0;   // to the left of the direction of walking, radians
  double pitch = 0;  // down
};

// Returns the waypoints of a walk over a plan that cuts its corners at `radius` before and after
// them (less on short legs).
std::vector<Waypoint> WalkAlong(const Eigen::Vector2d& start,
                                std::span<const Leg> legs,
                                double height,
                                double radius);

}  // namespace plumbline
