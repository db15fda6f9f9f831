// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/landmark_alignment.h"
#include "plumbline/loop_closing/local_landmarks.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <map>
#include <vector>

namespace plumbline {

// Landmarks of two places that may be the same, with their matches.
struct LoopMatches {
  AlignmentProblem problem;
  std::vector<LandmarkPair<PointId>> points;  // pair of each entry of AlignmentProblem::points
  std::vector<LandmarkPair<LineId>> lines;    // pair of each entry of AlignmentProblem::lines
};

// Result of searching each place's landmarks in the other's image.
struct MutualSearch {
  SearchedImage in_candidate;  // landmarks around the query, searched in the candidate's image
  SearchedImage in_query;      // landmarks around the candidate, searched in the query's image
  LoopMatches matches;
};

// Local landmarks of two keyframes. Landmarks common to both sides are ignored: two keyframes of
// one map would only repeat the map's relative pose.
class LoopSearch {
 public:
  // The maps must outlive this object; both may be the same map.
  LoopSearch(const Map& query_map,
             KeyFrameId query,
             const Map& candidate_map,
             KeyFrameId candidate,
             const CameraAndPyramid& imaging,
             int neighbours);

  const LocalLandmarks& query() const { return query_; }
  const LocalLandmarks& candidate() const { return candidate_; }

  // Returns pairs of landmarks of the two keyframes whose features match by descriptors: mutual
  // nearest neighbours, with a clearly worse second nearest.
  LoopMatches MatchDescriptors(const LoopVerificationOptions& options);

  // Searches landmarks at the projections of the relative pose. Contradictory pairs (one landmark
  // with two others) are dropped.
  MutualSearch SearchBoth(const Similarity3& candidate_from_query, double radius_px);

  // Searches landmarks around one keyframe in the image of a neighbour of the other, and adds the
  // resulting pairs.
  SearchedImage SearchInNeighbourOfQuery(KeyFrameId neighbour,
                                         const Similarity3& candidate_from_query,
                                         LoopMatches& matches);
  SearchedImage SearchInNeighbourOfCandidate(KeyFrameId neighbour,
                                             const Similarity3& candidate_from_query,
                                             LoopMatches& matches);

  // Removes contradictory and repeated pairs.
  void DropContradictions(LoopMatches& matches) const;

 private:
  void DropCommonLandmarks();
  void AddPair(PointId in_query, PointId in_candidate, LoopMatches& matches);
  void AddPair(LineId in_query, LineId in_candidate, LoopMatches& matches);
  void AddFoundInCandidate(const SearchedImage& found, LoopMatches& matches);
  void AddFoundInQuery(const SearchedImage& found, LoopMatches& matches);
  const CameraPoint& InQuery(PointId id);
  const CameraPoint& InCandidate(PointId id);

  const Map& query_map_;
  const Map& candidate_map_;
  CameraAndPyramid imaging_;
  LocalLandmarks query_, candidate_;
  std::vector<PointId> common_points_;  // ordered by id
  std::vector<LineId> common_lines_;
  // Cache of points in the frames of the two cameras.
  std::map<PointId, CameraPoint> in_query_, in_candidate_;
};

}  // namespace plumbline
