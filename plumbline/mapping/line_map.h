// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/line_map_options.h"
#include "plumbline/mapping/line_observation_search.h"
#include "plumbline/mapping/mapped_line.h"
#include "plumbline/matching/projection_search.h"

#include <vector>

namespace plumbline {

// An infinite line, the segments that show it, and its pieces that are fit to be given out.
struct WellSeenLine {
  PluckerLine line;  // world
  std::vector<LineSupport> supports;
  std::vector<MappedLine> pieces;  // at least one
};

// Returns the clean line map of a finished map: each line of the world once, where it is well seen.
//
// The landmarks serve tracking, which gains even from weak ones; here they are only hypotheses.
// They are taken one after the other, the one with most observations first. All segments of all
// keyframes that show the line are found, whatever landmark they were matched with
// (LineSupportSearch), and a new line is put through them; this is done three times. Of the parts
// that enough keyframes show (ShownParts), those stretches are kept that are known well enough,
// that enough of the keyframes show which have them in their image, and whose segments fit and are
// long enough (LineMapOptions). A line of which anything is kept claims its segments, so that other
// landmarks made of them find no support. This merges duplicates and the collinear pieces of one
// line. docs/methods/line-map.md has the figures.
//
//   map     in one frame with its keyframes' poses; not changed
//   stop    asked before each landmark; what was found until then is the result
//   result  in the order of the search: lines of the landmarks with most observations first
//   cost    O(landmarks x keyframes that may have them in their image)
std::vector<MappedLine> MakeLineMap(const Map& map,
                                    const CameraAndPyramid& imaging,
                                    const LineMapOptions& options,
                                    const StopCheck& stop = {});

// Returns the same lines as MakeLineMap, each with the segments of which it was made.
std::vector<WellSeenLine> FindWellSeenLines(const Map& map,
                                            const CameraAndPyramid& imaging,
                                            const LineMapOptions& options,
                                            const StopCheck& stop = {});

}  // namespace plumbline
