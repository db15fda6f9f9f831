// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/alignment_problem.h"

#include <optional>
#include <span>

namespace plumbline {

// Returns the similarity (scale 1 unless it is free) from the query's camera to the candidate's
// that aligns a few points and lines. Three matches are needed; two are enough if at least one is
// of lines.
//
// The rotation best aligns unit vectors (Kabsch 1976): the directions of lines (lines are
// directed), those between points, and those from lines to points, perpendicular to the lines.
// Scale and translation then solve the linear equations that points coincide, and that points of
// the query's lines lie on the candidate's.
//
// Returns nullopt if the matches are degenerate (collinear points, parallel lines alone, coplanar
// lines with free scale), or if the scale is negative.
std::optional<Similarity3> AlignSample(std::span<const AlignmentProblem::PointPair> points,
                                       std::span<const AlignmentProblem::LinePair> lines,
                                       bool free_scale);

}  // namespace plumbline
