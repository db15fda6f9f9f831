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

// Why a loop that was verified does not change the map.
enum class ClosingRefusal {
  kOutOfMap,       // keyframes of the loop are gone, or not tied to the rest
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

// The result of closing a loop.
struct LoopCorrection {
  MapEdit edit;                    // moves the keyframes, then fuses landmarks that are one
  std::vector<bool> earlier_kept;  // for each earlier edge: whether it agrees with the result
};

// Closes a loop of a map. The essential graph of the map (MakeEssentialGraph) is solved with all
// loops (SolvePoseGraph), by similarities with one camera, otherwise by rigid motions; the oldest
// keyframe and its unit stay. The keyframes move with all that refers to them
// (edit::MoveKeyFrames), and the pairs of the new loop are fused (FusePairs). The caller adjusts
// the surroundings and the whole map.
//
// Returns a refusal where the other loops contradict the new one (graduated non-convexity), or
// where one edge of odometry, or all together, would be bent by more than drift allows: a right
// loop raises the sum of chi2 by its degrees of freedom.
//
// Cost: about 0.1 s for 3,000 keyframes.
Expected<LoopCorrection, ClosingRefusal> CloseLoop(const Map& map,
                                                   const EssentialGraph& essential,
                                                   std::span<const LoopEdge> earlier,
                                                   const LoopEdge& newest,
                                                   const LoopOptions& options);

// Fuses pairs of landmarks that are one. The landmark of the query becomes part of that of the
// candidate, whose appearance is refreshed; the interval of a line covers both. Pairs of which a
// keyframe shows both landmarks stay apart, and so do pairs of which one is gone. Both landmarks
// must be in `map`; for maps that were joined, the pairs have the ids of today.
//
//   motion  motion of keyframes that the map makes before the fusion (for the intervals of lines)
MapEdit FusePairs(const Map& map,
                  std::span<const LandmarkPair<PointId>> points,
                  std::span<const LandmarkPair<LineId>> lines,
                  const edit::MoveKeyFrames& motion = {});

}  // namespace plumbline
