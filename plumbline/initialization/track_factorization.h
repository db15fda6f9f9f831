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

// How tracks are factorized.
struct FactorizationOptions {
  bool factorize = true;  // false: only step 1 is done, and all points follow from its poses
  bool interpolate = true;
  // Largest deviation of an interpolated place that is used [ideal image coordinates].
  double max_interpolation_sigma = 0.004;
  double min_line_angle = 0;  // least angle of the two epipolar lines, radians
  int reweighting = 5;        // steps of reweighting; 0: weighted least squares without a loss
};

// A start for a reconstruction: the pose of the newest frame and, where earlier tracks of the same
// reference gave them, the points.
struct MotionHypothesis {
  Rigid3 newest_from_reference;  // translation of any length but zero
  // Inverse distance along the unit ray of each point of the tracks, 0 where unknown. Empty: the
  // points follow from the two frames.
  std::vector<double> inverse_distances;
};

// Returns the pose of the newest frame from the points of a hypothesis that has points; nullopt
// where too few of them fit.
std::optional<Rigid3> ResectNewest(const FeatureTracks& tracks, const MotionHypothesis& hypothesis);

// Returns what a view contributes to the measurement matrix: the points seen, the rotation of the
// pose and the direction of its centre.
Rank1View Rank1ViewOf(const ViewPoints& seen, const Rigid3& pose);

// Finds motion and structure of all frames at once (first paper, section 2), from one hypothesis.
//
// 1. The points of the hypothesis give the poses of the frames between. Here the two
//    interpretations of a plane part: each gives other poses to all frames. A frame that does not
//    fit the points ends the hypothesis.
// 2. Rank-1 factorization of the points that all frames show gives all centres in one unit, so that
//    poses can be chained.
// 3. Geometric interpolation places points that the first and the newest frame show in frames that
//    do not show them, where the propagated standard deviation allows. Then all are factorized.
//
// Without `factorize` the poses of step 1 stay, and the points are triangulated from them.
//
//   returns  nullopt where a frame does not fit the hypothesis, or too few points are left
std::optional<Reconstruction> FactorizeTracks(const FeatureTracks& tracks,
                                              const MotionHypothesis& hypothesis,
                                              const FactorizationOptions& options);

// A reconstruction, and how many places were interpolated for it.
struct PairwiseReconstruction {
  Reconstruction reconstruction;
  int interpolated = 0;
};

// Finds motion and structure from poses that were found frame by frame, so that each translation
// has length one (first paper, section 2). Rank-1 factorization finds the lengths; without
// `options.factorize` they are chained from frame to frame by the depths of common points, and all
// points are triangulated.
//
// Interpolation needs the ratios of the translations: with unit lengths places are 15 px off in the
// median. Points that all frames show are therefore factorized first, or, where these are too few,
// all with their missing entries left out; then places are interpolated, and all points are
// factorized. The other two ways with missing places factorize twice as well, so that nothing but
// the places differs: the second time with the entries that there are (kLeaveOut), or again the
// points that all frames show (kTriangulate).
//
//   poses    view_from_reference of each view of the tracks
//   returns  nullopt where too few points are left, or most lie behind the cameras
std::optional<PairwiseReconstruction> FactorizePairwise(const FeatureTracks& tracks,
                                                        const std::vector<Rigid3>& poses,
                                                        MissingPlaces missing,
                                                        const FactorizationOptions& options);

}  // namespace plumbline
