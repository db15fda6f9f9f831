// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/window_tracks.h"

#include <vector>

namespace plumbline {

// How well a solution explains all that was matched.
struct WindowFit {
  // Squared reprojection errors over their variances, each at most `max_chi2`, summed over all
  // matches of all points with the reference: those of points without a place count in full.
  double cost = 0;
  int measurements = 0;  // that are summed, two coordinates each
  int inliers = 0;       // measurements within max_chi2
  // Noise of a measurement in units of the standard deviation assumed: the root mean square of the
  // errors, each limited as in `cost`, over the degrees of freedom that the parameters leave.
  double noise = 0;
};

//   max_chi2  in variances as assumed
WindowFit EvaluateWindow(const WindowTracks& tracks,
                         const WindowSolution& solution,
                         double max_chi2);

// A short joint bundle adjustment of all frames, points and lines that have a place on the matches
// alone (interpolated places are not measurements). The reference and, by damping, the unit stay.
WindowSolution AdjustWindow(const WindowTracks& tracks,
                            const WindowSolution& solution,
                            int max_iterations);

// The factor on the unit that brings the median depth in the reference to one, applied.
void ScaleToMedianDepth(WindowSolution& solution);

}  // namespace plumbline
