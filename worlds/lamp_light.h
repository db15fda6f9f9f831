// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/ray_tracer.h"
#include "worlds/scene.h"

#include <Eigen/Core>

namespace plumbline {

constexpr float kLampLift = 0.001F;  // metres off a surface, to avoid shadows by itself

// A point on a lamp, and the light on a white surface facing `normal` at `point` if the whole lamp
// were concentrated there and unoccluded.
struct LampPoint {
  Eigen::Vector3d position;
  double light;
};

// Number of sample points of a rectangular lamp in half shadow. No two are in line with a side of
// the lamp, so that the edge of a body covers them one by one.
constexpr int kLampPoints = 32;

// Returns sample point `number` in [0, kLampPoints); the first few are spread over the lamp as
// well.
Eigen::Vector3d PlaceOn(const Lamp& lamp, int number);
LampPoint LightFrom(const Lamp& lamp,
                    int number,
                    const Eigen::Vector3d& point,
                    const Eigen::Vector3d& normal);

// Returns the light of a lamp on a white surface facing `normal` at `point`, shadowed by static
// objects: each part of the lamp weighted by its contribution. 5 rays if they agree, otherwise
// kLampPoints more.
double LightOfLamp(const Lamp& lamp,
                   const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal,
                   const RayTracer& tracer);

}  // namespace plumbline
