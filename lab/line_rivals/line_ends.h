// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/optimization/problem.h"

#include <vector>

namespace plumbline {

// Returns two points on each line of a problem: the line trimmed by its observation in the first
// pose for which that is possible (eq. 26-30), in the line's direction. Lines without any get
// points one unit to both sides of their foot.
std::vector<Segment3> TrimmedEnds(const BaProblem& problem);

// Returns the ends of lines that are two points: those of the problem; if it has none, TrimmedEnds.
std::vector<Segment3> EndsOf(const BaProblem& problem);

// Returns the moved ends; if two are too near each other to determine a line, those of `before`.
std::vector<Segment3> EndsOfLines(const std::vector<Segment3>& before,
                                  const std::vector<Segment3>& moved);

// Returns the lines through moved ends. If the ends are those of `before`, the line is that of
// `lines`, bit by bit.
std::vector<OrthonormalLine> LinesThroughEnds(const std::vector<OrthonormalLine>& lines,
                                              const std::vector<Segment3>& before,
                                              const std::vector<Segment3>& ends);

}  // namespace plumbline
