// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/line_maps/line_viewers.h"
#include "lab/line_maps/surface_distance.h"
#include "plumbline/geometry/segment.h"
#include "worlds/parallelogram.h"
#include "worlds/true_line.h"

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

struct LineMapErrorOptions {
  // Distances that count as covered, metres, ascending.
  std::vector<double> tolerances = {0.01, 0.02, 0.05, 0.10};
  // Largest difference of matching directions [radians]. A segment of 10 cm differs by 5 degrees if
  // its ends are 4 mm off to opposite sides: a smaller limit would refuse short segments for
  // ordinary noise, while a much larger one would let a line that merely crosses another one cover
  // it. Long segments are limited more by the tolerance.
  double max_angle = 5 * std::numbers::pi / 180;
  // Recall counts the stretches seen by enough of these viewers from near enough (SeenStretches).
  // nullopt: all of each line seen by enough frames of the sequence. Other stretches still count as
  // true.
  std::optional<LineViewers> viewers;
  int min_visible_frames = 3;  // used without viewers
  // Least distance [metres] from all surfaces of a point in the air.
  double surface_limit = 0.05;
};

// The true line that corresponds to an estimated segment.
struct LineCounterpart {
  std::size_t true_line = 0;  // index of the true line
  // Index of the smallest tolerance at which at least half of the segment is covered.
  std::size_t tolerance = 0;
  double angle = 0;  // in radians
  // Root mean square over the part within the tolerance, in metres.
  double distance = 0;
};

// Results at one tolerance. Shares are in [0, 1]; nullopt for shares and medians of nothing.
struct LineMapErrorAt {
  double tolerance = 0;          // metres
  std::optional<double> recall;  // share of the expected length that was found
  std::array<std::optional<double>, kTrueLineKinds> recall_by_kind;  // recall of each TrueLineKind
  std::optional<double> precision;        // share of the estimated length that is right
  std::size_t with_counterpart = 0;       // estimated segments with a counterpart
  std::optional<double> median_angle;     // median angle to the true lines, radians
  std::optional<double> median_distance;  // median distance from the true lines, metres
  std::optional<double> segments_per_line;
  std::optional<double> multiplicity;
};

struct LineMapError {
  std::size_t true_lines = 0, asked_lines = 0;  // all lines; those seen in enough frames
  double true_length = 0, asked_length = 0;     // their lengths in metres
  std::size_t estimated_segments = 0;
  double estimated_length = 0;
  std::vector<LineMapErrorAt> at;  // one for each tolerance
  // Estimated length that no true line covers at the largest tolerance, and its distance from
  // surfaces: nullopt without surfaces or without such length.
  double uncovered_length = 0;
  std::optional<SurfaceDistance> uncovered_from_surfaces;
  std::vector<bool> asked;  // for each true line: true if it counts for recall
  std::vector<std::optional<LineCounterpart>>
      counterparts;  // the true line of each estimated segment
};

// Compares a line map with the lines of a known world. At each tolerance:
//
// A point of a segment is covered if a segment of the other set whose direction agrees to max_angle
// has a point within the tolerance. The points that one segment covers of another are an interval,
// computed in closed form (StretchWithin); their union is measured exactly, without sampling.
//   recall            covered length of the true lines seen in at least min_visible_frames frames
//                     (or in an unrecorded number) by their length; the same for each kind
//   precision         covered length of the estimated segments by their length; all true lines
//                     cover, however rarely they are seen
//   counterpart       of an estimated segment, at the smallest tolerance at which at least half of
//                     it is covered: among the true lines that cover at least 90 % as much of it as
//                     the one that covers most, the nearest (then the first). Nearest in the root
//                     mean square distance, over the part it covers, from the infinite line. Each
//                     tolerance counts the segments with a counterpart at it or a smaller one
//   segments_per_line segments with a counterpart by distinct true lines among the counterparts
//   multiplicity      number of times that the mapped stretches of true lines are mapped: the sum
//                     of the lengths of all segments projected orthogonally onto their counterparts
//                     and cut at their ends, by the length of the unions of these stretches. 1: no
//                     part twice, even if in many pieces
//
//   truth     metres, world of the ground truth
//   estimate  in the same world; segments of no length do not matter
//   surfaces  of the same world; may be empty
//   cost      O(n m) tests of bounding boxes, and closed forms for what lies close together: 0.1 s
//             for 5000 by 5000 segments in a furnished room, 0.3 s more where 2.5 km of them are
//             far from 5000 surfaces
LineMapError CompareLineMaps(std::span<const TrueLine> truth,
                             std::span<const Segment3> estimate,
                             std::span<const Parallelogram> surfaces,
                             const LineMapErrorOptions& options);

}  // namespace plumbline
