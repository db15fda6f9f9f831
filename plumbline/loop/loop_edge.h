// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/map.h"

#include <vector>

namespace plumbline {

// Why two keyframes are taken to see the same place.
struct LoopEvidence {
  int first_matches = 0;  // points + 2 lines that looked alike
  int inlier_points = 0;  // that agree with the relative pose, in both keyframes together
  int inlier_lines = 0;
  int tested = 0;           // landmarks that should be in view, in both keyframes together
  double chance_share = 0;  // of the tested that a wrong relative pose would find
  double log10_chance = 0;  // logarithm of the probability of as many by chance
  double rival_share = 0;   // found under another shift of the image / found
  double spread = 0;        // of the inliers in the image, along the least axis / its height
  double area_share = 0;    // of the cells that should show landmarks those that do
  int asked = 0;            // neighbouring keyframes that were asked
  int confirmed = 0;        // of them those that agree

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.first_matches,
          self.inlier_points,
          self.inlier_lines,
          self.tested,
          self.chance_share,
          self.log10_chance);
    visit(self.rival_share, self.spread, self.area_share, self.asked, self.confirmed);
  }
};

template <class LandmarkId>
struct LandmarkPair {
  LandmarkId in_query, in_candidate;

  friend auto operator<=>(const LandmarkPair&, const LandmarkPair&) = default;

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.in_query, self.in_candidate);
  }
};

// Two keyframes that see the same place, of one map or of two, and where they are to each other.
struct LoopEdge {
  KeyFrameId query, candidate;
  // Takes a place in the camera of the query to the camera of the candidate, each in the unit that
  // lengths around its keyframe had then (KeyFrame::unit): no motion of a map changes it but one
  // that scales. Scale 1 where depth is measured.
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale] of candidate_from_query.
  // Where depth is measured the last row and column are zero.
  Matrix7d covariance = Matrix7d::Zero();
  double query_unit = 1, candidate_unit = 1;  // KeyFrame::unit of then
  // Landmarks that are one: of the query's map and of the candidate's. Each appears once.
  std::vector<LandmarkPair<PointId>> points;
  std::vector<LandmarkPair<LineId>> lines;
  LoopEvidence evidence;

  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.query, self.candidate, self.candidate_from_query, self.covariance);
    visit(self.query_unit, self.candidate_unit, self.points, self.lines, self.evidence);
  }
};

// The relative pose in the units that the keyframes have today.
Similarity3 CandidateFromQueryToday(const LoopEdge& edge,
                                    double query_unit_today,
                                    double candidate_unit_today);

// The inverse of the covariance; with measured depth the last row and column are zero.
Matrix7d InformationOf(const LoopEdge& edge);

// Takes the world of the query's map to that of the candidate's, as the edge has it and both
// keyframes stand today. For maps that are to be joined.
Similarity3 CandidateWorldFromQueryWorld(const Map& query_map,
                                         const Map& candidate_map,
                                         const LoopEdge& edge);

}  // namespace plumbline
