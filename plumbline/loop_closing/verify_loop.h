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

// Reason why two keyframes are not accepted as the same place.
enum class LoopRefusal {
  kFewMatches,   // few features match by descriptor
  kNoAgreement,  // the descriptor matches agree on no relative pose
  kFewInliers,   // few landmarks are found at their predicted projections
  kLoose,        // the matches leave the relative pose undetermined
  kChance,       // a wrong relative pose might match as many
  kRepeated,     // another shift of the image matches nearly as many
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

// Verifies that two keyframes, of one map or of two, see the same place, and estimates their
// relative pose: a similarity with one camera (baseline 0), otherwise a rigid motion.
//
// Landmarks of the two matched by descriptors give a first relative pose (AlignByRansac). With it
// the landmarks around each keyframe are searched in the other's image, and the relative pose is
// refined from the matches, points and lines together (RefineAlignment). Both steps are repeated
// with a smaller search radius. Landmarks already shown by both keyframes (of one map) are ignored.
//
// The result is accepted if the number of matches cannot be chance: it is compared, by the tail of
// the binomial distribution, with that of the same search at the best wrong shift of the image. The
// matches must also cover the image, determine the relative pose, and be found by neighbours of the
// query.
//
// The covariance is that of RefineAlignment, but never smaller than with independent_matches, since
// the errors of a map's landmarks are correlated.
//
// If the query has no neighbours to be tested, evidence.asked is 0, and the caller must wait for
// another query. The same input gives the same result.
//
//   cost  a refused candidate about 5 ms, an accepted one about 30 ms (1000 features)
Expected<LoopEdge, LoopRefusal> VerifyLoop(const Map& query_map,
                                           KeyFrameId query,
                                           const Map& candidate_map,
                                           KeyFrameId candidate,
                                           const CameraAndPyramid& imaging,
                                           const LoopVerificationOptions& options);

}  // namespace plumbline
