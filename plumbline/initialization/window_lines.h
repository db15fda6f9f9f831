// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/window_tracks.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// The camera whose pixels are ideal image coordinates.
inline constexpr RectifiedCamera kIdealCamera = [] {
  RectifiedCamera camera;
  camera.fx = camera.fy = 1;
  return camera;
}();

// What a frame shows of line k, its standard deviation times `noise`.
LineMeasurement MeasurementOf(const TrackedLines& view, std::size_t k, double noise = 1);

// The lines of the window from the poses of a solution (TriangulateLine), one entry by line:
// nullopt where it would lie behind a camera, or its views hardly differ.
std::vector<std::optional<PluckerLine>> TriangulateLines(const WindowTracks& tracks,
                                                         const WindowSolution& solution);

// Squared distances of the ends of a line's segments from its image over their variances.
struct LineFit {
  double cost = 0;    // each view at most `max_chi2`; those of a line without a place in full
  bool fits = false;  // in every view that shows it
  double chi2 = 0;    // not limited
  int freedom = 0;    // two a view, less four
};

//   max_chi2  of the two ends in one view
//   returns   by line of the tracks; empty where lines do not take part
std::vector<LineFit> EvaluateLines(const WindowTracks& tracks,
                                   const WindowSolution& solution,
                                   double max_chi2);

// Those with a place that fit every view: 99 % of chi2 with two degrees of freedom.
std::vector<std::size_t> LinesThatFit(const WindowTracks& tracks, const WindowSolution& solution);

}  // namespace plumbline
