// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/line_observation_search.h"
#include "plumbline/mapping/mapped_line.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/projection_search.h"

#include <vector>

namespace plumbline {

// An infinite line, its segments, and its pieces for output.
struct WellSeenLine {
  PluckerLine line;  // world
  std::vector<LineSupport> supports;
  std::vector<MappedLine> pieces;  // at least one
};

// Returns the clean line map of a finished map: each well observed line of the world once.
//
// The landmarks serve tracking, which gains even from weak ones; here they are only hypotheses, in
// the order of their numbers of observations. All segments of all keyframes that show the line are
// found, whatever landmark they were matched with (LineSupportSearch), and a new line is fitted to
// them; this is repeated three times. Searched are keyframes up to three times as far from the line
// as the furthest that observes it. Of the parts that enough keyframes show (ShownParts), those
// intervals are kept whose uncertainty is small enough, that are shown by enough of the keyframes
// that have them in their image, and whose segments fit and are long enough (LineMapOptions). A
// line with any kept interval claims its segments, so that other landmarks made from them find no
// support. This merges duplicates and the collinear pieces of one line. docs/methods/line-map.md
// has the figures.
//
//   map     in one frame with its keyframes' poses; not changed
//   stop    called before each landmark; when stopped, the result is what was found so far
//   result  in the order of the search: lines of the landmarks with most observations first
//   cost    O(landmarks x keyframes that may have them in their image)
std::vector<MappedLine> MakeLineMap(const Map& map,
                                    const CameraAndPyramid& imaging,
                                    const LineMapOptions& options,
                                    const StopCheck& stop = {});

// Returns the same lines as MakeLineMap, each with its segments.
std::vector<WellSeenLine> FindWellSeenLines(const Map& map,
                                            const CameraAndPyramid& imaging,
                                            const LineMapOptions& options,
                                            const StopCheck& stop = {});

}  // namespace plumbline
