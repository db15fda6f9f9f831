// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Where one frame shows the points of the reference: ideal image coordinates (x/z, y/z).
struct TrackedPoints {
  std::vector<Eigen::Vector2d> points;  // by point of the reference
  std::vector<double> sigmas;           // standard deviation of each coordinate; 0: not matched

  bool Has(std::size_t point) const { return sigmas[point] > 0; }
  std::size_t CountSeen() const {
    return static_cast<std::size_t>(
        std::count_if(sigmas.begin(), sigmas.end(), [](double sigma) { return sigma > 0; }));
  }
};

// Where one frame shows the lines of the reference: segments in ideal image coordinates.
struct TrackedLines {
  std::vector<Segment2> segments;  // by line of the reference
  std::vector<double> sigmas;      // standard deviation of each end across the line; 0: not matched

  bool Has(std::size_t line) const { return sigmas[line] > 0; }
};

// The lines of a reference frame that at least two later frames show: two views of a line say
// nothing about the cameras, three do.
struct WindowLines {
  TrackedLines reference;           // has all
  std::vector<TrackedLines> views;  // by view; empty: there are no lines

  std::size_t size() const { return reference.segments.size(); }
};

// The points and lines of a reference frame in later frames, as they were really matched.
struct WindowTracks {
  TrackedPoints reference;           // has all
  std::vector<TrackedPoints> views;  // by time; the last is the newest frame
  std::vector<int> features;         // features of the reference, by point
  WindowLines lines;

  std::size_t size() const { return reference.points.size(); }
};

// Multiplies the standard deviations of a window's points (WindowTracks) or lines (WindowLines).
template <class Tracks>
void ScaleSigmas(double factor, Tracks& tracks) {
  const auto scale = [factor](auto& tracked) {
    for (double& sigma : tracked.sigmas) sigma *= factor;
  };
  scale(tracks.reference);
  for (auto& view : tracks.views) scale(view);
}

// One explanation of a window of frames: the reference's camera is the world, its unit free.
struct WindowSolution {
  std::vector<Rigid3> cam_from_reference;  // by view
  std::vector<Eigen::Vector3d> points;     // by point of the reference
  std::vector<bool> is_known;              // by point: false where there is no place for it
  // By line of the reference; nullopt: no place. Empty where lines do not take part.
  std::vector<std::optional<PluckerLine>> lines = {};
};

}  // namespace plumbline
