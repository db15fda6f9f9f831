// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// A closed track along a rectangle with round corners, counterclockwise.
struct Track {
  Eigen::Vector2d centre;
  Eigen::Vector2d half;  // half its size
  double radius;         // of the corners
  double speed;          // m/s, negative: clockwise
  double start;          // metres along it at time 0
  double z = 0;

  // Pose on the track, with x ahead.
  Rigid3 At(double time) const;
};

}  // namespace plumbline
