// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/built_in/furniture.h"
#include "worlds/scene_builder.h"

#include <Eigen/Core>

namespace plumbline {

// A house with windows and a door to the front; the place is the middle of its front at the foot.
struct HouseShape {
  double length = 11, depth = 8;  // along the street and away from it, metres
  int storeys = 2;
};
void AddHouse(SceneBuilder& scene, const Place& place, const HouseShape& shape);

// A car, 4.2 m long along the x axis of its place, which is the middle of the ground under it.
void AddCar(SceneBuilder& scene, const Place& place);

// A tree: a stem, and leaves on panels in all orientations around the middle of its crown.
void AddTree(SceneBuilder& scene, const Eigen::Vector3d& foot);

// A lamp post, 4.5 to 6 m tall, with an arm to the front of the place.
void AddLampPost(SceneBuilder& scene, const Place& place);

}  // namespace plumbline
