// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/alignment_problem.h"

#include <optional>
#include <span>

namespace plumbline {

// Returns the similarity (scale 1 unless it is free) that takes a few points and lines of the
// query's camera to the candidate's. Three matches are needed; two are enough where at least one is
// of lines.
//
// The rotation turns vectors of unit length upon each other as well as it can (Kabsch 1976): the
// directions of lines (lines are directed), those between points, and those from lines to points,
// perpendicular to the lines. Scale and translation then solve the linear equations that points
// meet, and that places of the query's lines lie on the candidate's.
//
// Returns nullopt where the matches are degenerate (points in a row, parallel lines alone, lines of
// one plane where the scale is free), or where the scale comes out negative.
std::optional<Similarity3> AlignSample(std::span<const AlignmentProblem::PointPair> points,
                                       std::span<const AlignmentProblem::LinePair> lines,
                                       bool free_scale);

}  // namespace plumbline
