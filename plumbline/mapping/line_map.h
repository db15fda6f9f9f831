// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/line_map_options.h"
#include "plumbline/mapping/line_support.h"

#include <vector>

namespace plumbline {

// A straight piece of the world's lines, as given to users.
struct MappedLine {
  Segment3 segment;   // world; directed with the brighter side as LineFeature says
  double sigma = 0;   // of the worse end, across the line, in the map's unit, poses taken as known
  int keyframes = 0;  // that show some of it
};

// What is drawn of lines: their segments.
std::vector<Segment3> SegmentsOf(const std::vector<MappedLine>& lines);

// An infinite line with what shows it and what is fit to be given out of it.
struct WellSeenLine {
  PluckerLine line;  // world
  std::vector<LineSupport> supports;
  std::vector<MappedLine> pieces;  // at least one
};

// The clean line map of a finished map: what is well seen of its lines, each once.
//
// The landmarks serve tracking, which gains from weak ones; here they are hypotheses only. One
// after the other, the one with most observations first: all segments of all keyframes that show
// the line are found, whatever they were matched with (LineSupportSearch), the line goes through
// them anew, and again, three times in all. Of its parts, those that enough keyframes show
// (ShownParts), the stretches are kept that are known well enough, that enough of the keyframes
// show which have them in their image, and whose segments fit and are long enough (LineMapOptions).
// A line of which anything is kept claims its segments, so that what else was made of them finds no
// support: this merges duplicates, and the collinear pieces of one line. docs/methods/line-map.md
// has the figures.
//
//   map     in one frame with its keyframes' poses; not changed
//   stop    asked before each landmark; what was found until then is the result
//   result  in the order in which the lines were made
//   cost    O(landmarks x keyframes that may have them in their image)
std::vector<MappedLine> MakeLineMap(const Map& map,
                                    const ImagingModel& imaging,
                                    const LineMapOptions& options,
                                    const StopCheck& stop = {});

// FindWellSeenLines with what the lines were made of.
std::vector<WellSeenLine> FindWellSeenLines(const Map& map,
                                            const ImagingModel& imaging,
                                            const LineMapOptions& options,
                                            const StopCheck& stop = {});

}  // namespace plumbline
