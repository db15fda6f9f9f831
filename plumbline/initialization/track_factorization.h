// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/initialization/options.h"
#include "plumbline/initialization/rank1_factorization.h"
#include "plumbline/initialization/reconstruction.h"

#include <optional>
#include <vector>

namespace plumbline {

// Settings of factorization.
struct FactorizationOptions {
  bool factorize = true;  // false: only step 1 is done, and all points follow from its poses
  bool interpolate = true;
  // Largest standard deviation of a usable interpolated position [ideal image coordinates].
  double max_interpolation_sigma = 0.004;
  double min_line_angle = 0;  // least angle between the two epipolar lines, radians
  int reweighting = 5;        // steps of reweighting; 0: weighted least squares without a loss
};

// Initial guess of a reconstruction: the pose of the newest frame and, if earlier tracks of the
// same reference gave them, the points.
struct MotionHypothesis {
  Rigid3 newest_from_reference;  // translation of any length but zero
  // Inverse distance along the unit ray of each point of the tracks, 0 if unknown. Empty: the
  // points follow from the two frames.
  std::vector<double> inverse_distances;
};

// Returns the pose of the newest frame from the points of a hypothesis that has points; nullopt if
// too few of them fit.
std::optional<Rigid3> ResectNewest(const FeatureTracks& tracks, const MotionHypothesis& hypothesis);

// Returns the rows of a view in the measurement matrix: its points, the rotation of the pose and
// the direction of its centre.
Rank1View Rank1ViewOf(const ViewPoints& seen, const Rigid3& pose);

// Finds motion and structure of all frames at once (first paper, section 2), from one hypothesis.
//
// 1. The points of the hypothesis give the poses of the intermediate frames. This separates the two
//    interpretations of a plane: each gives other poses to all frames. A frame that does not fit
//    the points ends the hypothesis.
// 2. Rank-1 factorization of the points visible in all frames gives all centres in one scale, so
//    that poses can be chained.
// 3. Geometric interpolation adds the missing positions of points visible in the first and the
//    newest frame, if the propagated standard deviation allows. Then all are factorized.
//
// Without `factorize` the poses of step 1 are final, and the points are triangulated from them.
//
//   returns  nullopt if a frame does not fit the hypothesis, or too few points remain
std::optional<Reconstruction> FactorizeTracks(const FeatureTracks& tracks,
                                              const MotionHypothesis& hypothesis,
                                              const FactorizationOptions& options);

// A reconstruction, and the number of positions interpolated for it.
struct PairwiseReconstruction {
  Reconstruction reconstruction;
  int interpolated = 0;
};

// Computes motion and structure from poses estimated frame by frame, with translations of length
// one (first paper, section 2). Rank-1 factorization estimates the lengths; without
// `options.factorize` they are chained from frame to frame by the depths of common points, and all
// points are triangulated.
//
// Interpolation needs the ratios of the translations: with unit lengths positions are 15 px off in
// the median. Points visible in all frames are therefore factorized first, or, if these are too
// few, all with their missing entries left out; then positions are interpolated, and all points are
// factorized. The other two treatments of missing positions factorize twice as well, so that only
// the positions differ: the second time with the existing entries (kLeaveOut), or again the points
// visible in all frames (kTriangulate).
//
//   poses    view_from_reference of each view of the tracks
//   returns  nullopt if too few points remain, or most lie behind the cameras
std::optional<PairwiseReconstruction> FactorizePairwise(const FeatureTracks& tracks,
                                                        const std::vector<Rigid3>& poses,
                                                        MissingPlaces missing,
                                                        const FactorizationOptions& options);

}  // namespace plumbline
