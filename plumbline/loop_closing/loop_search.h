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

// Landmarks of two places that may be one, with their matches.
struct LoopMatches {
  AlignmentProblem problem;
  std::vector<LandmarkPair<PointId>> points;  // the pair of each entry of AlignmentProblem::points
  std::vector<LandmarkPair<LineId>> lines;    // the pair of each entry of AlignmentProblem::lines
};

// The result of searching each place's landmarks in the other's image.
struct MutualSearch {
  SearchedImage in_candidate;  // landmarks around the query, searched in the candidate's image
  SearchedImage in_query;      // landmarks around the candidate, searched in the query's image
  LoopMatches matches;
};

// The landmarks that two keyframes and their neighbourhoods show. Landmarks that both sides have in
// common take no part: two keyframes of one map would only repeat what the map says.
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

  // Returns pairs of landmarks of the two keyframes whose features look alike: their descriptors
  // are nearest to each other, and the second nearest are clearly worse.
  LoopMatches MatchDescriptors(const LoopVerificationOptions& options);

  // Searches landmarks where the relative pose predicts them. Pairs that contradict each other (one
  // landmark with two others) are left out.
  MutualSearch SearchBoth(const Similarity3& candidate_from_query, double radius_px);

  // Searches landmarks around one keyframe in the image of a neighbour of the other, and adds the
  // resulting pairs.
  SearchedImage SearchInNeighbourOfQuery(KeyFrameId neighbour,
                                         const Similarity3& candidate_from_query,
                                         LoopMatches& matches);
  SearchedImage SearchInNeighbourOfCandidate(KeyFrameId neighbour,
                                             const Similarity3& candidate_from_query,
                                             LoopMatches& matches);

  // Removes pairs that contradict each other, and repeated pairs.
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
  // Points in the frames of the two cameras, as far as they were computed.
  std::map<PointId, CameraPoint> in_query_, in_candidate_;
};

}  // namespace plumbline
