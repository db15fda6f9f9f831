// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <string>
#include <vector>

namespace plumbline {

// The line landmarks of the first run of each variant on a sequence, each between the ends that it
// has in map.plb, in the world of the ground truth (ReadLinesInTrueWorld). A column for each
// variant, all of the same scale and view. Where the true lines are known they are grey, landmarks
// with a true line within 5 cm green, and those without red; else landmarks are black. The true
// path is blue. What lies outside the view is cut off: the view holds all true lines or, where they
// are not known, the path and nine of ten ends of all variants.
//
// Both are SVG, empty where no run has ground truth and a map. A variant whose map cannot be read
// is left out; InputError where the true lines, or the image, cannot be read.

// Figure 10 of the first paper: all of the map, from above and from the side. "Above" is along the
// axis in which the camera truly moves least (AxesOfMostMotion).
std::string LineMapsPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence);

// Figure 11 of the first paper: an image, that of KeyFrameWithMostLines of the first variant, and
// of each variant the lines seen in its keyframe nearest in time: from the camera of the image (its
// axes, no perspective) and from above it.
std::string LineAreaPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence);

// The keyframe that shows the most lines of the map, among those in the middle half of the run.
// Throws InputError where there is no keyframe with lines.
const KeyFrame& KeyFrameWithMostLines(const Map& map);

}  // namespace plumbline
