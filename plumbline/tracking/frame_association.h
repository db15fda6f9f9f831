// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/ids.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/snapshot.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// A landmark that a frame may show: of the map, or (invalid id) made on the spot from one frame.
struct CandidatePoint {
  PointId id;
  PointModel model;
  // Covariance of the position, in the world; zero where it counts as known. (A line's is in its
  // model.)
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
struct CandidateLine {
  LineId id;
  LineModel model;
};

// Which feature of a frame shows which of some candidates: -1 or an index into them.
struct FrameMatches {
  std::vector<int> point_of_feature;
  std::vector<int> line_of_feature;

  FrameMatches() = default;
  FrameMatches(std::size_t point_features, std::size_t line_features)
      : point_of_feature(point_features, -1), line_of_feature(line_features, -1) {}

  int Points() const;
  int Lines() const;
  int All() const { return Points() + Lines(); }
};

struct FrameAssociation {
  std::vector<CandidatePoint> points;
  std::vector<CandidateLine> lines;
  FrameMatches matches;  // of these

  FrameAssociation() = default;
  // No candidates and no matches.
  FrameAssociation(std::size_t point_features, std::size_t line_features)
      : matches(point_features, line_features) {}
};

// The matches of a frame of the map, with landmarks that are in the snapshot.
FrameAssociation AssociationOf(const Frame& frame, const MapSnapshot& snapshot);

// Matches with landmarks of the map.
int MatchesOfMap(const FrameAssociation& association);

// Copies the matches with landmarks of the map (or only the others) of features that have none in
// `to` yet.
void CopyMatches(const FrameAssociation& from, bool of_map, FrameAssociation& to);

// Takes the matches with landmarks that fewer than `views` keyframes show out of an association
// (none shows those made on the spot) and returns them.
FrameMatches TakeOutYoung(const MapSnapshot& snapshot, int views, FrameAssociation& association);

// Matches of `from`, with the same candidates, for the features that have none in `to`.
void PutBack(const FrameMatches& from, FrameMatches& to);

// Features that have a match in both.
int CommonMatches(const FrameMatches& a, const FrameMatches& b);

// Indices of the candidates that were projected into the image (expected to be seen).
struct ExpectedLandmarks {
  std::vector<int> points;
  std::vector<int> lines;
};

// Writes down which landmarks of the map the features of a frame show; those without a match and
// those made on the spot show none.
void SetLandmarks(const FrameAssociation& association, Frame& frame);

// Counts for each landmark of the map that it was to be seen, and that it was found.
void CountSeen(const ExpectedLandmarks& expected,
               const FrameAssociation& association,
               TrackingScores& scores);

// Projects the candidates with the given pose and matches those without a match with the features
// without a match. Returns all candidates that should be visible, matched or not.
ExpectedLandmarks MatchCandidates(const ImagingModel& imaging,
                                  const IndexedFeatures& image,
                                  const Rigid3& cam_from_world,
                                  const ProjectionSearchOptions& options,
                                  FrameAssociation& association);

}  // namespace plumbline
