// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/ray_tracer.h"
#include "worlds/scene.h"

#include <Eigen/Core>

namespace plumbline {

constexpr float kLampLift = 0.001F;  // metres off a surface, not to be shadowed by itself

// A point on a lamp, and the light that a white surface facing `normal` at `point` gets from the
// whole lamp if it were gathered there and nothing stood between.
struct LampPoint {
  Eigen::Vector3d position;
  double light;
};

// How many points stand for a rectangular lamp in half shadow. No two are in line with a side of
// the lamp, so that the edge of a body covers them one by one.
constexpr int kLampPoints = 32;

// The point of that number in [0, kLampPoints); the first few are spread over the lamp as well.
Eigen::Vector3d PlaceOn(const Lamp& lamp, int number);
LampPoint LightFrom(const Lamp& lamp,
                    int number,
                    const Eigen::Vector3d& point,
                    const Eigen::Vector3d& normal);

// The light that a white surface facing `normal` at `point` gets from a lamp past all that stands
// still: each part of the lamp weighted by what it gives. 5 rays where they agree, else kLampPoints
// more.
double LightOfLamp(const Lamp& lamp,
                   const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal,
                   const RayTracer& tracer);

}  // namespace plumbline
