// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Where one frame shows the points of the reference: ideal image coordinates (x/z, y/z).
struct TrackedPoints {
  std::vector<Eigen::Vector2d> points;  // by point of the reference
  std::vector<double> sigmas;           // standard deviation of each coordinate; 0: not matched

  bool Has(std::size_t point) const { return sigmas[point] > 0; }
};

// The points of a reference frame in later frames, as they were really matched.
struct WindowTracks {
  TrackedPoints reference;           // has all
  std::vector<TrackedPoints> views;  // by time; the last is the newest frame
  std::vector<int> features;         // of the reference, by point

  std::size_t size() const { return reference.points.size(); }
};

// One explanation of a window of frames: the reference's camera is the world, its unit free.
struct WindowSolution {
  std::vector<Rigid3> cam_from_reference;  // by view
  std::vector<Eigen::Vector3d> points;     // by point of the reference
  std::vector<bool> is_known;              // by point: false where there is no place for it
};

}  // namespace plumbline
