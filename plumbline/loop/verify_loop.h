// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/loop/loop_edge.h"
#include "plumbline/loop/options.h"
#include "plumbline/map/map.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// Why two keyframes are not taken to see the same place.
enum class LoopRefusal {
  kFewMatches,   // few features look alike
  kNoAgreement,  // those that do agree on no relative pose
  kFewInliers,   // little is found where the relative pose says it should be
  kLoose,        // what is found leaves the relative pose open
  kChance,       // a wrong relative pose might find as much
  kRepeated,     // another shift of the image finds nearly as much
  kNarrow,       // it is all in one small part of the image
  kUnconfirmed,  // neighbouring keyframes do not find it
};

constexpr auto EnumNames(std::type_identity<LoopRefusal>) {
  return std::array{std::pair{LoopRefusal::kFewMatches, "few_matches"},
                    std::pair{LoopRefusal::kNoAgreement, "no_agreement"},
                    std::pair{LoopRefusal::kFewInliers, "few_inliers"},
                    std::pair{LoopRefusal::kLoose, "loose"},
                    std::pair{LoopRefusal::kChance, "chance"},
                    std::pair{LoopRefusal::kRepeated, "repeated"},
                    std::pair{LoopRefusal::kNarrow, "narrow"},
                    std::pair{LoopRefusal::kUnconfirmed, "unconfirmed"}};
}

// Whether two keyframes, of one map or of two, see the same place, and where they are to each
// other: a similarity with one camera (baseline 0), else a rigid motion.
//
// Landmarks of the two whose features look alike give a first relative pose (AlignByRansac). With
// it the landmarks around each are searched for in the other's image, and the relative pose is
// refined from what is found, points and lines together (RefineAlignment); then once more, closer
// by. What both sides have in common already (landmarks of one map that both show) does not take
// part.
//
// Believed where so many matches cannot be chance: they are set against how many the same search
// would find at the best wrong shift of the image, by the tail of the binomial distribution. They
// must also cover the image, fix the relative pose, and be found by keyframes beside the query.
//
// The covariance is that of RefineAlignment, but never smaller than what independent_matches would
// leave: the errors of a map's landmarks have much in common.
//
// Where the query has no neighbours that could be asked, evidence.asked is 0, and the caller must
// wait for another query. Same input, same result.
//
//   cost  a refused candidate about 5 ms, an accepted one about 30 ms (1000 features)
Expected<LoopEdge, LoopRefusal> VerifyLoop(const Map& query_map,
                                           KeyFrameId query,
                                           const Map& candidate_map,
                                           KeyFrameId candidate,
                                           const ImagingModel& imaging,
                                           const LoopVerificationOptions& options);

}  // namespace plumbline
