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

// The inside of a room of a building, floor at z = 0: a rectangle of the plan. Neighbours are as
// far apart as the wall between them is thick.
struct RoomPlan {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Ones();
  double height = 2.7;
  Material wall = Material::kPaint;
  double wall_tone = 0.7;
  Material floor = Material::kCarpet;
  double floor_tone = 0.4;
  double skirting = 0.08;  // height; 0: none
  bool grid = true;        // a suspended ceiling in a grid of 0.6 m; else a plain one

  CeilingGrid Ceiling() const;
};

// A hole through a wall: a rectangle of the plan, between two heights. It belongs to each room it
// touches with a whole side: two rooms are joined, one gets a niche for a window. One without depth
// joins rooms that touch. `frame`: a door frame on each face.
struct Passage {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double bottom = 0;
  double top = 2.05;
  bool frame = true;
};

// Walls with their holes, floors, ceilings, skirtings, and the edges where they meet.
void AddBuilding(SceneBuilder& scene,
                 std::span<const RoomPlan> rooms,
                 std::span<const Passage> passages);

// A straight piece of a walk: where it ends and where the walker looks.
struct Leg {
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double gaze = 0;   // to the left of the direction of walking, radians
  double pitch = 0;  // down
};

// Waypoints of a walk over a plan that cuts its corners at `radius` before and after them (less on
// short legs).
std::vector<Waypoint> WalkAlong(const Eigen::Vector2d& start,
                                std::span<const Leg> legs,
                                double height,
                                double radius);

}  // namespace plumbline
