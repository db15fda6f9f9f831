// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_maps/line_map_error.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/report/figure.h"
#include "plumbline/report/trajectory_error.h"
#include "worlds/true_line.h"

#include <optional>
#include <span>

#include <Eigen/Geometry>

namespace plumbline {

// Draws a line map over the lines of the known world, from above and from the side. True lines are
// grey (light if too few frames see them), estimated segments green with a counterpart, and red
// without.
//
//   truth, estimate, error  as given to CompareLineMaps, and its result
//   poses                   of the same world; "above" is along the axis in which the reference
//                           moves least
//
// The view is that of the true lines; the rest is cut off.
Figure LineMapFigure(std::span<const TrueLine> truth,
                     std::span<const Segment3> estimate,
                     const LineMapError& error,
                     std::span<const EvaluatedPose> poses);

// Returns the part of a segment inside a box (Liang and Barsky, A new concept and method for line
// clipping, 1984).
std::optional<Segment2> Clipped(const Segment2& segment, const Eigen::AlignedBox2d& box);

}  // namespace plumbline
