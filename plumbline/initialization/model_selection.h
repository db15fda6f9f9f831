// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/initialization/candidate_models.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/track_factorization.h"
#include "plumbline/solvers/relative_pose.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

struct ModelSelectionOptions {
  FactorizationOptions factorization;
  RelativePoseMethod relative_pose = RelativePoseMethod::kFivePoint;
};

struct ModelSelection {
  InitializationWait wait = InitializationWait::kNone;
  double parallax_deg = 0;  // median over the points of the newest frame; 0: unknown
  std::optional<Reconstruction> reconstruction = std::nullopt;  // its median depth is one
};

// The models of earlier tracks of the same reference that could not be ruled out, as hypotheses for
// the next: what the newest frame can tell may be less than what earlier ones could.
class PriorHypotheses {
 public:
  void Clear();
  // The best first; `sure`: it would have been accepted.
  void Keep(const Tracks& tracks, std::span<const CandidateModel> models, bool sure);
  std::vector<MotionHypothesis> HypothesesFor(const Tracks& tracks) const;
  // Whether the best was sure and its points see the newest frame where the reconstruction has it:
  // what is found by chance is not found twice.
  bool Confirm(const Tracks& tracks, const Reconstruction& reconstruction) const;

  // All that it keeps (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.hypotheses_, self.sure_);
  }

 private:
  struct Hypothesis {
    Rigid3 newest_from_reference;
    std::map<int, double> inverse_distances;  // by feature of the reference

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.newest_from_reference, self.inverse_distances);
    }
  };
  std::vector<Hypothesis> hypotheses_;
  bool sure_ = false;
};

// Reconstructs the tracks in all ways that the newest frame allows and says whether one of them is
// right beyond doubt:
//
//  - every hypothesis of the motion to the newest frame (essential matrix and homography, all their
//    decompositions), and every prior one, is carried through all frames (FactorizeTracks) and
//    adjusted to all matches;
//  - 24 points and lines of the newest frame, 12 of them points, 85 % inliers and 1.2 degrees of
//    parallax are the least;
//  - the best must beat every other that differs in motion by a margin of chi2 that noise does not
//    make (kAmbiguous otherwise): so the two interpretations of a plane are told apart;
//  - the first-order covariance must promise what the map is to be (kTooLittleParallax or
//    kInaccurate otherwise). A camera that stands or turns leaves depth and direction free, which
//    the covariance says; so does a small thing that moves before a camera at rest, since the
//    median is that of all points;
//  - the selection of the frame before must have been as sure, and agree.
//
// Never tells more than the model knows: a scene most of which moves as one rigid body is taken for
// a camera that moves.
ModelSelection SelectModel(const Tracks& tracks,
                           const ModelSelectionOptions& options,
                           PriorHypotheses& prior,
                           Rng& rng);

}  // namespace plumbline
