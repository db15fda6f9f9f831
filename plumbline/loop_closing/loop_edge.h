// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/map.h"

#include <vector>

namespace plumbline {

// A relative pose b_from_a with the covariance of its left perturbation [rotation, translation, log
// scale]. For a rigid motion the last row and column are zero.
struct PoseWithCovariance {
  Similarity3 pose;
  Matrix7d covariance = Matrix7d::Zero();
};

// Returns c_from_b * b_from_a; the estimates count as independent, to first order.
PoseWithCovariance Compose(const PoseWithCovariance& c_from_b, const PoseWithCovariance& b_from_a);

// Returns a_from_b with the covariance of b_from_a propagated to first order.
PoseWithCovariance Inverse(const PoseWithCovariance& b_from_a);

// Returns the squared Mahalanobis norm of Log(pose): the closing error of a cycle of relative
// poses. Rigid motions (no variance of the scale) have six degrees of freedom, others seven.
// Infinite if the covariance is not positive definite.
double ClosingChi2(const PoseWithCovariance& a_from_a);

// Evidence that two keyframes see the same place.
struct LoopEvidence {
  int first_matches = 0;  // points + 2 lines with similar descriptors
  // Points consistent with the relative pose, in both keyframes together.
  int inlier_points = 0;
  int inlier_lines = 0;
  // Landmarks predicted in view, in both keyframes together.
  int tested = 0;
  // Share of the tested landmarks that a wrong relative pose would match.
  double chance_share = 0;
  // Decimal logarithm of the probability of this many matches by chance.
  double log10_chance = 0;
  // Matches under another shift of the image / matches found.
  double rival_share = 0;
  // Standard deviation of the inliers in the image, along the least axis / height of the image.
  double spread = 0;
  // Share of the cells with predicted landmarks that have matches.
  double area_share = 0;
  int asked = 0;      // neighbouring keyframes that were asked
  int confirmed = 0;  // asked keyframes that agree
};

// Two landmarks, around the query and around the candidate, that are the same in the world, by id
// or as models.
template <class Landmark>
struct LandmarkPair {
  Landmark in_query, in_candidate;

  friend auto operator<=>(const LandmarkPair&, const LandmarkPair&) = default;
};

// Two keyframes that see the same place, of one map or of two maps, and their relative pose.
struct LoopEdge {
  KeyFrameId query, candidate;
  // Transforms points from the camera of the query to the camera of the candidate. Each camera has
  // the scale of its keyframe when the edge was measured (KeyFrame::scale), so that only motions of
  // a map with a change of scale affect it. The scale is 1 if depth is measured.
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale] of candidate_from_query.
  // If depth is measured the last row and column are zero.
  Matrix7d covariance = Matrix7d::Zero();
  double query_scale = 1, candidate_scale = 1;  // KeyFrame::scale when the edge was measured
  // Pairs of the same landmark in the query's map and in the candidate's. Each landmark appears
  // once.
  std::vector<LandmarkPair<PointId>> points;
  std::vector<LandmarkPair<LineId>> lines;
  LoopEvidence evidence;
};

// Returns the relative pose in the current scales of the keyframes.
Similarity3 CandidateFromQueryToday(const LoopEdge& edge,
                                    double query_scale_today,
                                    double candidate_scale_today);

// Returns the inverse of the covariance; if depth is measured the last row and column are zero.
Matrix7d InformationOf(const LoopEdge& edge);

// Returns the similarity from the world of the query's map to that of the candidate's, from the
// edge and the current poses of both keyframes. For maps to be merged.
Similarity3 CandidateWorldFromQueryWorld(const Map& query_map,
                                         const Map& candidate_map,
                                         const LoopEdge& edge);

}  // namespace plumbline
