// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/window_explanation.h"
#include "plumbline/initialization/window_tracks.h"

#include <vector>

namespace plumbline {

// The explanations of a window by its points, adjusted to points and lines together.
//
//  - Lines are triangulated from the poses of each explanation and join its bundle adjustment, with
//    the noise of their fit to the best one, at least `min_noise` of what is said.
//  - A line speaks for an explanation when it fits every view that shows it; the cost of an
//    explanation is that of its points and of the lines that fit any of them. Wrong matches, which
//    fit none, do not count.
//  - The cost is a valley along what is least known, and may have two minima there that lie further
//    apart than either covariance says. So the best explanation is moved 6 degrees to either side
//    along the valley and adjusted again: another minimum is another explanation.
//
//   tracks        its lines get the noise found
//   explanations  the best first; not empty
//   returns       distinct ones, the best first
//   cost          some milliseconds for 50 points and 30 lines in four views
std::vector<Explanation> ExplainWithLines(WindowTracks& tracks,
                                          std::vector<Explanation> explanations,
                                          double min_noise);

}  // namespace plumbline
