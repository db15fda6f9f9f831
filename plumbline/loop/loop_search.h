// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/loop/landmark_alignment.h"
#include "plumbline/loop/local_landmarks.h"
#include "plumbline/loop/loop_edge.h"
#include "plumbline/loop/options.h"
#include "plumbline/map/map.h"

#include <map>
#include <vector>

namespace plumbline {

// Landmarks of two places that may be one, and their matches.
struct LoopMatches {
  AlignmentProblem problem;
  std::vector<LandmarkPair<PointId>> points;  // by AlignmentProblem::points
  std::vector<LandmarkPair<LineId>> lines;    // by AlignmentProblem::lines
};

// A search of both places in each other's image.
struct MutualSearch {
  SearchedImage in_candidate;  // landmarks around the query
  SearchedImage in_query;      // landmarks around the candidate
  LoopMatches matches;
};

// What two keyframes and their neighbourhoods show. Landmarks that both sides have in common do not
// take part: of two keyframes of one map they say what the map says.
class LoopSearch {
 public:
  // The maps must outlive it; they may be one.
  LoopSearch(const Map& query_map,
             KeyFrameId query,
             const Map& candidate_map,
             KeyFrameId candidate,
             const ImagingModel& imaging,
             int neighbours);

  const LocalLandmarks& query() const { return query_; }
  const LocalLandmarks& candidate() const { return candidate_; }

  // Landmarks of the two keyframes whose features look alike: mutually nearest descriptors with
  // clear second ones.
  LoopMatches MatchByLooks(const LoopVerificationOptions& options);

  // Landmarks found where the relative pose says. Pairs of landmarks that contradict each other
  // (one with two) are left out.
  MutualSearch SearchBoth(const Similarity3& candidate_from_query, double radius_px);

  // Landmarks around one of the two searched for in the image of a neighbour of the other, and the
  // pairs this gives.
  SearchedImage SearchInNeighbourOfQuery(KeyFrameId neighbour,
                                         const Similarity3& candidate_from_query,
                                         LoopMatches& matches);
  SearchedImage SearchInNeighbourOfCandidate(KeyFrameId neighbour,
                                             const Similarity3& candidate_from_query,
                                             LoopMatches& matches);

  // Without pairs that contradict each other or stand there twice.
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
  ImagingModel imaging_;
  LocalLandmarks query_, candidate_;
  std::vector<PointId> common_points_;  // ascending
  std::vector<LineId> common_lines_;
  std::map<PointId, CameraPoint> in_query_, in_candidate_;  // computed so far
};

}  // namespace plumbline
