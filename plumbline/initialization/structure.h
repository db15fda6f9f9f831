// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/initializer.h"

#include <span>
#include <vector>

namespace plumbline {

// The features of several views that should show one landmark: at least two, by view.
using FeatureTrack = std::vector<InitialObservation>;

struct StructureOptions {
  double min_parallax_deg = 0.3;
  double max_relative_sigma = 0.3;       // largest standard deviation / depth of a point
  double max_line_relative_sigma = 0.1;  // largest standard deviation / depth across a line
};

// Points and lines from views whose poses are known.
//
// A point must lie in front of all its views, agree with them (chi2 at 95 %) and be known well
// enough in depth. A line must have interpretation planes at an angle that fixes it, end in front
// of all views, pass through the ends of its segments, and lie at a depth like that of the points:
// two segments always meet in some line, so that with two views its depth is the one thing that
// gives away a wrong match.
//
//   point_tracks, line_tracks  indices into `views` and the features of the frames there
//   returns                    the map in the world of the views' poses; tracks that fail are left
//                              out
//   cost                       O(tracks)
InitialMap BuildStructure(const RectifiedCamera& camera,
                          std::vector<InitialView> views,
                          std::span<const FeatureTrack> point_tracks,
                          std::span<const FeatureTrack> line_tracks,
                          const StructureOptions& options = {});

// The median depth of the points in the first view; 0 without points.
double MedianDepth(const InitialMap& map);

// Scales the map (poses, points, lines) by a factor about the world's origin.
void ScaleMap(double factor, InitialMap& map);

// Adjusts all poses but the first, all points and lines to all observations, drops observations
// that do not fit (chi2 at 95 %) and landmarks that are left with fewer than two, and makes the
// median depth in the first view 1.
//
//   map   not empty; the first view's camera is the world
//   cost  some milliseconds for three views and 300 points
void AdjustStructure(const RectifiedCamera& camera, InitialMap& map);

}  // namespace plumbline
