// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/loop/essential_graph.h"
#include "plumbline/loop/loop_edge.h"
#include "plumbline/loop/options.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Why a loop that was verified does not change the map.
enum class ClosingRefusal {
  kOutOfMap,       // its keyframes are gone, or not tied to the rest
  kNotSolved,      // the pose graph has no solution
  kContradicted,   // the graph with all other loops leaves it out
  kBendsOdometry,  // it would bend the odometry more than that can have drifted
};

constexpr auto EnumNames(std::type_identity<ClosingRefusal>) {
  return std::array{std::pair{ClosingRefusal::kOutOfMap, "out_of_map"},
                    std::pair{ClosingRefusal::kNotSolved, "not_solved"},
                    std::pair{ClosingRefusal::kContradicted, "contradicted"},
                    std::pair{ClosingRefusal::kBendsOdometry, "bends_odometry"}};
}

// What closing a loop makes of a map.
struct LoopCorrection {
  MapEdit edit;                    // the keyframes move, then landmarks that are one are fused
  std::vector<bool> earlier_kept;  // by earlier edge: it agrees with the result
  int merged_points = 0, merged_lines = 0;
  double largest_shift = 0;        // of a keyframe, map units
  double largest_turn = 0;         // of a keyframe, radians
  double query_scale = 1;          // of lengths around the query
  double raised_chi2 = 0;          // of all edges of the graph together, by the new loop
  double worst_odometry_chi2 = 0;  // of an edge between keyframes
};

// The map with a loop closed: its essential graph (MakeEssentialGraph) with all loops is solved
// (SolvePoseGraph), similarities with one camera, else rigid motions; the oldest keyframe and its
// unit stay. The keyframes move (edit::MoveKeyFrames) with what hangs on them, and the
// pairs of the new loop are fused (FusePairs). Local and whole adjustment are the caller's.
//
// Nothing is changed where the loops contradict the new one (graduated non-convexity) or where an
// edge of odometry, or all together, would be bent by more than drift allows: a right loop raises
// the sum of chi2 by its degrees of freedom.
//
// Cost: about 0.1 s for 3,000 keyframes.
Expected<LoopCorrection, ClosingRefusal> CloseLoop(const Map& map,
                                                   EssentialGraph essential,
                                                   std::span<const LoopEdge> earlier,
                                                   const LoopEdge& newest,
                                                   const LoopOptions& options);

// Landmarks that are one made one: those of the query pass to those of the candidate, with their
// appearance anew; a line's interval covers both. Pairs of which a keyframe shows both stay apart,
// and so do those that are gone. Both must be in `map`; for maps that were joined, the pairs by the
// ids of today.
//
//   motion  of keyframes, that the map makes before (for the intervals of lines)
MapEdit FusePairs(const Map& map,
                  std::span<const LandmarkPair<PointId>> points,
                  std::span<const LandmarkPair<LineId>> lines,
                  const edit::MoveKeyFrames& motion = {});

}  // namespace plumbline
