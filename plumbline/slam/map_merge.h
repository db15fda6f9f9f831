// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/loop/loop_edge.h"
#include "plumbline/map/atlas.h"
#include "plumbline/slam/options.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Why two maps are not made one.
enum class MergeRefusal {
  kNoOverlap,     // less than two keyframes of the second map show places of the first
  kAmbiguous,     // they show places of the first, but nearly as many say the second is elsewhere
  kContradicted,  // the shapes of the maps do not allow what they say
};

constexpr auto EnumNames(std::type_identity<MergeRefusal>) {
  return std::array{std::pair{MergeRefusal::kNoOverlap, "no_overlap"},
                    std::pair{MergeRefusal::kAmbiguous, "ambiguous"},
                    std::pair{MergeRefusal::kContradicted, "contradicted"}};
}

// Two maps as one.
struct MergedMaps {
  Atlas atlas;                    // the joined map is the active one
  Similarity3 first_from_second;  // of the worlds, as the surest edge has it
  std::vector<LoopEdge> overlap;  // what the merge rests on, the surest first; queries are
                                  // keyframes of the second
  int ties = 0;                   // keyframes of the second that were fused with the first
};

// Where keyframes of one map show places of another: each keyframe of the second is compared with
// the three of the first that look most alike (PlaceIndex, VerifyLoop). Ends with 40 edges, which
// are then spread over the second. Same maps, same edges. Cost: some tens of milliseconds for each
// keyframe of the second.
std::vector<LoopEdge> FindOverlap(const Map& first,
                                  const Map& second,
                                  const ImagingModel& imaging,
                                  const LoopVerificationOptions& options);

// Makes one map of two that nobody has related to each other yet. `first`, the older one, stays
// with its world.
//
// The edges between the two (FindOverlap) must agree: of those that close cycles with each other by
// way of odometry (Mangelson et al., ICRA 2018) the largest set is taken, of two keyframes of the
// second at least, and with more than twice as many as any set that disagrees with it (rooms that
// look alike). The surest edge joins the maps (JoinBy), all together bend the joined map
// (CloseLoop); what the edges pair is fused. From there on more is fused and adjusted around each
// keyframe of the second that shares landmarks with the first, and at last the whole map is
// adjusted (LocalMapper::Tie, Finish).
//
// One camera: the second also gets the unit of the first. Same input, same result.
//
//   cost  FindOverlap, some tenths of a second for each keyframe that both share, AdjustWholeMap
Expected<MergedMaps, MergeRefusal> MergeBySight(const Atlas& atlas,
                                                MapId first,
                                                MapId second,
                                                const ImagingModel& imaging,
                                                const SlamOptions& options);

}  // namespace plumbline
