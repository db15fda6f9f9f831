// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <vector>

namespace plumbline {

// A straight piece of the world's lines, as given to users.
struct MappedLine {
  Segment3 segment;  // in the world; directed with the brighter side as LineFeature says
  // Deviation of the worse end across the line, in the map's unit; poses count as exact.
  double sigma = 0;
  int keyframes = 0;  // number of keyframes that show some of it
};

// Returns the segments of lines, for drawing.
std::vector<Segment3> SegmentsOf(const std::vector<MappedLine>& lines);

}  // namespace plumbline
