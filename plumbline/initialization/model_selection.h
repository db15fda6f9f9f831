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
  InitializationStatus wait = InitializationStatus::kNone;
  // Median over the points of the newest frame; 0 where unknown.
  double parallax_deg = 0;
  std::optional<Reconstruction> reconstruction = std::nullopt;  // its median depth is one
};

// Keeps the models of earlier tracks of the same reference that could not be ruled out, as
// hypotheses for the next tracks: the newest frame may tell less than earlier frames could.
class PriorHypotheses {
 public:
  void Clear();
  // Keeps the models, the best first. `sure` says that the best would have been accepted.
  void Keep(const FeatureTracks& tracks, std::span<const CandidateModel> models, bool sure);
  std::vector<MotionHypothesis> HypothesesFor(const FeatureTracks& tracks) const;
  // Whether the best kept model was sure, and its points give the newest frame the pose that the
  // reconstruction has. What was found by chance is not found twice.
  bool Confirm(const FeatureTracks& tracks, const Reconstruction& reconstruction) const;

 private:
  struct Hypothesis {
    Rigid3 newest_from_reference;
    std::map<int, double> inverse_distances;  // keyed by feature of the reference
  };
  std::vector<Hypothesis> hypotheses_;
  bool sure_ = false;
};

// Reconstructs the tracks in all ways that the newest frame allows, and decides whether one of them
// is right beyond doubt:
//
//  - Every hypothesis of the motion to the newest frame (essential matrix and homography, all their
//    decompositions), and every prior one, is carried through all frames (FactorizeTracks) and
//    adjusted to all matches.
//  - At least 24 points and lines of the newest frame are needed, 12 of them points, with 85 %
//    inliers and 1.2 degrees of parallax.
//  - The best model must beat every model with another motion by a margin of chi2 that noise does
//    not make (kAmbiguous otherwise). This tells the two interpretations of a plane apart.
//  - The first-order covariance must promise the accuracy that a map needs (kTooLittleParallax or
//    kInaccurate otherwise). A camera that stands or turns leaves depth and direction free, which
//    the covariance shows. It also shows a small thing that moves before a camera at rest, since
//    the median is that of all points.
//  - The selection of the frame before must have been as sure, and agree.
//
// The model has one limit: a scene most of which moves as one rigid body looks like a camera that
// moves.
ModelSelection SelectModel(const FeatureTracks& tracks,
                           const ModelSelectionOptions& options,
                           PriorHypotheses& prior,
                           Rng& rng);

}  // namespace plumbline
