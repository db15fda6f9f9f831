// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// A straight piece of a line of the world, for output.
struct MappedLine {
  Segment3 segment;  // in the world; direction by its brighter side (LineFeature)
  // Deviation of the worse end across the line, in the map's scale; poses count as exact.
  double sigma = 0;
  int keyframes = 0;  // number of keyframes that show a part of it
};

// Returns the segments of lines, for drawing.
std::vector<Segment3> SegmentsOf(const std::vector<MappedLine>& lines);

// Memory of the lines in local bundle adjustment, summed over all windows.
struct AdjustedLines {
  std::size_t count = 0;
  std::size_t bytes = 0;
};

}  // namespace plumbline
