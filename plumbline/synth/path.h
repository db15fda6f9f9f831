// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>

#include <Eigen/Core>

namespace plumbline {

// A camera carried by hand around an ellipse, looking outward: steps, sway and a wandering gaze on
// top. Smooth, and closed after `loop_s` seconds (the sway repeats with the loop).
class HandHeldLoop {
 public:
  struct Shape {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world, metres
    double radius_x = 1.0, radius_y = 0.8;             // metres
    double loop_s = 10;                                // seconds for one turn
    std::uint64_t seed = 1;                            // of the phases of sway and gaze
  };

  explicit HandHeldLoop(const Shape& shape);

  // Pose of the camera (x right, y down, z forward) in the world (z up) at a time in seconds.
  Rigid3 WorldFromCamera(double time) const;

 private:
  // Sum of a few sines with whole numbers of periods in a loop.
  double Wander(double time, int channel, int first_period, double size) const;

  Shape shape_;
};

}  // namespace plumbline
