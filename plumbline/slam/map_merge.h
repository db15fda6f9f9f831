// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/atlas.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/system_methods.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Reason why two maps are not merged.
enum class MergeRefusal {
  kNoOverlap,  // fewer than two keyframes of the second map show places of the first
  // The edges disagree about the pose of the second map: besides the largest consistent set there
  // is a second one with at least half as many keyframes of the second map.
  kAmbiguous,
  kContradicted,  // the shapes of the maps do not allow the edges
};

constexpr auto EnumNames(std::type_identity<MergeRefusal>) {
  return std::array{std::pair{MergeRefusal::kNoOverlap, "no_overlap"},
                    std::pair{MergeRefusal::kAmbiguous, "ambiguous"},
                    std::pair{MergeRefusal::kContradicted, "contradicted"}};
}

// Result of a merge.
struct MergedMaps {
  Atlas atlas;                    // the joined map is the active one
  Similarity3 first_from_second;  // from world to world, by the most certain edge
  // The edges of the merge, the most certain first. The query of each is a keyframe of the second
  // map.
  std::vector<LoopEdge> overlap;
  int ties = 0;  // keyframes of the second map that were fused with the first
};

// Finds pairs of keyframes of two maps that show the same place. Each keyframe of the second map is
// compared with the three keyframes of the first most similar in appearance (PlaceIndex,
// VerifyLoop). The search ends with 40 edges, which are then spread over the second map. The same
// maps give the same edges. Cost: some tens of milliseconds for each keyframe of the second map.
std::vector<LoopEdge> FindOverlap(const Map& first,
                                  const Map& second,
                                  const CameraAndPyramid& imaging,
                                  const LoopVerificationOptions& options);

// Merges two unrelated maps. `first`, the older one, keeps its world.
//
// The edges between the two (FindOverlap) must agree. The largest set is taken of edges that
// pairwise close consistent cycles with odometry (Mangelson et al., ICRA 2018). It must have edges
// of at least two keyframes of the second map, and more than twice as many of them as any set
// inconsistent with it (rooms may be similar). The most certain edge joins the maps (JoinMaps), all
// edges together correct the merged map (CloseLoop), and the landmarks that they pair are fused.
// More landmarks are then fused and adjusted around each keyframe of the second map that shares
// landmarks with the first, and finally the whole map is adjusted
// (LocalMapper::AdjustLoopNeighbourhood, Finish).
//
// With one camera the second map also gets the scale of the first. The same input gives the same
// result.
//
//   cost FindOverlap, some tenths of a second for each keyframe common to both, AdjustWholeMap
Expected<MergedMaps, MergeRefusal> MergeMaps(const Atlas& atlas,
                                             MapId first,
                                             MapId second,
                                             const CameraAndPyramid& imaging,
                                             const SlamOptions& options,
                                             const SystemMethods& methods = {});

}  // namespace plumbline
