// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumbline {

// The line landmarks of the first run of each variant on a sequence, each between its ends in
// map.plb, in the world of the ground truth (ReadLinesInTrueWorld). A column for each variant, all
// of the same scale and view. If the true lines are known they are grey, landmarks with a true line
// within 5 cm green, and those without red; otherwise landmarks are black. The true path is blue.
// The view contains all true lines or, if they are unknown, the path and nine of ten ends of all
// variants; the rest is clipped.
//
// Both are SVG, empty if no run has ground truth and a map. A variant whose map cannot be read is
// left out; InputError if the true lines, or the image, cannot be read.

// Figure 10 of the first paper: the whole map, from above and from the side. "Above" is along the
// axis in which the camera truly moves least (AxesOfMostMotion).
std::string LineMapsPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence);

// Figure 11 of the first paper: an image, that of KeyFrameWithMostLines of the first variant, and
// of each variant the lines observed by its keyframe nearest in time: from the camera of the image
// (its axes, no perspective) and from above it.
std::string LineAreaPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence);

// Returns the keyframe with the most lines of the map, among those in the middle half of the run.
// Throws InputError if there is no keyframe with lines.
const KeyFrame& KeyFrameWithMostLines(const Map& map);

}  // namespace plumbline
