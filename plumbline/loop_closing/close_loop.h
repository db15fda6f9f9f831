// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Reason why a verified loop does not change the map.
enum class ClosingRefusal {
  kOutOfMap,       // keyframes of the loop have left the map or are disconnected
  kNotSolved,      // the pose graph has no solution
  kContradicted,   // the graph with all other loops gives it no weight
  kBendsOdometry,  // it would bend the odometry more than odometry can have drifted
};

constexpr auto EnumNames(std::type_identity<ClosingRefusal>) {
  return std::array{std::pair{ClosingRefusal::kOutOfMap, "out_of_map"},
                    std::pair{ClosingRefusal::kNotSolved, "not_solved"},
                    std::pair{ClosingRefusal::kContradicted, "contradicted"},
                    std::pair{ClosingRefusal::kBendsOdometry, "bends_odometry"}};
}

// Result of closing a loop.
struct LoopCorrection {
  MapEdit edit;  // moves the keyframes, then fuses matched landmarks
  // for each earlier edge: true if it is consistent with the result
  std::vector<bool> earlier_kept;
};

// Closes a loop of a map. The essential graph of the map (MakeEssentialGraph) is solved with all
// loops (SolvePoseGraph), by similarities with one camera, otherwise by rigid motions; the oldest
// keyframe and its scale are fixed. The keyframes move with everything relative to them
// (edit::MoveKeyFrames), and the pairs of the new loop are fused (FusePairs). The caller adjusts
// the neighbourhood and the whole map.
//
// Returns a refusal if the other loops contradict the new one (graduated non-convexity), or if it
// would bend one edge of odometry, or all together, more than drift allows: a right loop raises the
// sum of chi2 by its degrees of freedom.
//
// Cost: about 0.1 s for 3,000 keyframes.
Expected<LoopCorrection, ClosingRefusal> CloseLoop(const Map& map,
                                                   const EssentialGraph& essential,
                                                   std::span<const LoopEdge> earlier,
                                                   const LoopEdge& newest,
                                                   const LoopOptions& options);

// Fuses pairs of landmarks. The landmark of the query becomes part of that of the candidate, whose
// appearance is refreshed; the interval of a line covers both. Pairs stay apart if a keyframe shows
// both landmarks, or if one has left the map. Both landmarks must be in `map`; for merged maps, the
// pairs have their current ids.
//
//   motion  motion of keyframes that the map makes before the fusion (for the intervals of lines)
MapEdit FusePairs(const Map& map,
                  std::span<const LandmarkPair<PointId>> points,
                  std::span<const LandmarkPair<LineId>> lines,
                  const edit::MoveKeyFrames& motion = {});

// Undoes the fusions of a loop: the inverse of CloseLoop, for a loop that proved wrong. A landmark
// is split if keyframes around the candidate and keyframes around the query show it, and no
// keyframe showed it during at least half of the keyframes between the two. Observations of the
// later half go to a new landmark at the same position; the appearance of both is refreshed. It
// does not matter whether the landmark was fused when the loop was closed, with other duplicates
// around it, or by frames tracked against both parts since.
//
// Keyframes do not move. Odometry is stored only in the images; the caller must adjust the whole
// map, which restores it after the split. Landmarks that another loop connects between the same
// surroundings are split, too, and are found again like those of any place.
//
// Returns no changes if a keyframe of the loop has left the map without an ancestor. O(matches of
// the keyframes around the query).
MapEdit UndoLoop(const Map& map, const LoopEdge& loop);

}  // namespace plumbline
