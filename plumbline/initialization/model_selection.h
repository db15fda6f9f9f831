// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/inertial/gyroscope.h"
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
  // Median over the points of the newest frame; 0 if unknown.
  double parallax_deg = 0;
  std::optional<Reconstruction> reconstruction = std::nullopt;  // its median depth is one
};

// Stores the models of earlier tracks of the same reference that could not be ruled out, as
// hypotheses for the next tracks: the newest frame may be less informative than earlier frames.
class PriorHypotheses {
 public:
  void Clear();
  // Stores the models, the best first. `sure` is true if the best would have been accepted.
  void Keep(const FeatureTracks& tracks, std::span<const CandidateModel> models, bool sure);
  std::vector<MotionHypothesis> HypothesesFor(const FeatureTracks& tracks) const;
  // Returns true if the best stored model was sure, and its points give the newest frame the pose
  // of the reconstruction. Chance results do not repeat.
  bool Confirm(const FeatureTracks& tracks, const Reconstruction& reconstruction) const;

 private:
  struct Hypothesis {
    Rigid3 newest_from_reference;
    std::map<int, double> inverse_distances;  // keyed by feature of the reference
  };
  std::vector<Hypothesis> hypotheses_;
  bool sure_ = false;
};

// The turns of the camera from the reference to each view by a gyroscope, and the covariance of
// its errors, which are the same for all of them.
struct MeasuredTurns {
  std::vector<CameraTurn> of_views;
  Matrix7d errors = Matrix7d::Identity();
};

// Returns the chi2 of a model's rotations by the measured turns, with as many degrees of freedom
// as three times the views.
double TurnChi2(const MeasuredTurns& turns, const Reconstruction& reconstruction);

// Reconstructs the tracks by all hypotheses for the newest frame, and decides whether one is
// certain to be right:
//
//  - Every hypothesis of the motion to the newest frame (essential matrix and homography, all their
//    decompositions), and every prior one, is extended to all frames (FactorizeTracks) and adjusted
//    to all matches.
//  - At least 24 points and lines of the newest frame are needed, 12 of them points, with 85 %
//    inliers and 1.2 degrees of parallax.
//  - The best model must beat every model with another motion by a margin of chi2 above that of
//    noise (kAmbiguous otherwise). This resolves the two interpretations of a plane.
//  - With a gyroscope, models whose rotations it excludes do not count, unless it excludes all. The
//    wrong interpretation of a plane turns by other angles.
//  - The first-order covariance must reach the accuracy that a map needs (kTooLittleParallax or
//    kInaccurate otherwise). A camera that stands or turns leaves depth and direction undetermined,
//    as the covariance shows. It also reveals a small object that moves in front of a camera at
//    rest, since the median is that of all points.
//  - The selection of the previous frame must have been as certain, and agree.
//
// One limit: a scene most of which moves as one rigid body is indistinguishable from camera motion.
ModelSelection SelectModel(const FeatureTracks& tracks,
                           const ModelSelectionOptions& options,
                           PriorHypotheses& prior,
                           Rng& rng,
                           const std::optional<MeasuredTurns>& turns = std::nullopt);

}  // namespace plumbline
