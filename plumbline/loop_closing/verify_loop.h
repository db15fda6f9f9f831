// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// Why two keyframes are not taken to see the same place.
enum class LoopRefusal {
  kFewMatches,   // few features look alike
  kNoAgreement,  // the features that look alike agree on no relative pose
  kFewInliers,   // few landmarks are found where the relative pose predicts them
  kLoose,        // the matches leave the relative pose open
  kChance,       // a wrong relative pose might find as much
  kRepeated,     // another shift of the image finds nearly as much
  kNarrow,       // all matches lie in one small part of the image
  kUnconfirmed,  // neighbouring keyframes do not confirm it
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

// Decides whether two keyframes, of one map or of two, see the same place, and finds their relative
// pose: a similarity with one camera (baseline 0), otherwise a rigid motion.
//
// Landmarks of the two whose features look alike give a first relative pose (AlignByRansac). With
// it the landmarks around each keyframe are searched in the other's image, and the relative pose is
// refined from the matches, points and lines together (RefineAlignment). Both is repeated with a
// smaller search radius. Landmarks that both keyframes show already (of one map) take no part.
//
// The result is believed where so many matches cannot be chance: their number is compared, by the
// tail of the binomial distribution, with what the same search would find at the best wrong shift
// of the image. The matches must also cover the image, fix the relative pose, and be found by
// keyframes beside the query.
//
// The covariance is that of RefineAlignment, but never smaller than what independent_matches would
// leave, since the errors of a map's landmarks have much in common.
//
// Where the query has no neighbours that could be asked, evidence.asked is 0, and the caller must
// wait for another query. The same input gives the same result.
//
//   cost  a refused candidate about 5 ms, an accepted one about 30 ms (1000 features)
Expected<LoopEdge, LoopRefusal> VerifyLoop(const Map& query_map,
                                           KeyFrameId query,
                                           const Map& candidate_map,
                                           KeyFrameId candidate,
                                           const CameraAndPyramid& imaging,
                                           const LoopVerificationOptions& options);

}  // namespace plumbline
