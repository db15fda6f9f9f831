// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/matching/projection_search.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {

// A landmark that a frame may show. It is one of the map, or, with an invalid id, one that was made
// on the spot from the depths of one frame.
struct PointCandidate {
  PointId id;
  PointModel model;
  // Covariance of the position in the world; zero where the position counts as known. A line has
  // its covariance in its model.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
// A line that a frame may show, with a valid or an invalid id as PointCandidate.
struct LineCandidate {
  LineId id;
  LineModel model;
};

// Which of some candidates each feature of a frame shows: an index into the candidates, or -1 for
// none.
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

// Landmarks that a frame may show, and which of them its features show.
struct LandmarkMatches {
  std::vector<PointCandidate> points;
  std::vector<LineCandidate> lines;
  FrameMatches matches;  // their indices refer to these points and lines
  // Pose of the frame whose depths made the landmarks that are not of the map; nullopt where none
  // were made.
  std::optional<Rigid3> made_from;

  LandmarkMatches() = default;
  // An association without candidates and matches.
  LandmarkMatches(std::size_t point_features, std::size_t line_features)
      : matches(point_features, line_features) {}
};

// Returns the matches that a frame of the map has with landmarks in the snapshot.
LandmarkMatches AssociationOf(const Frame& frame, const MapSnapshot& snapshot);

// Counts the matches with landmarks of the map.
int MatchesOfMap(const LandmarkMatches& association);

// Copies matches of features that have none in `to` yet: with `of_map` those with landmarks of the
// map, without it those with landmarks made on the spot.
void CopyMatches(const LandmarkMatches& from, bool of_map, LandmarkMatches& to);

// Takes the matches with young landmarks out of an association and returns them. A landmark is
// young if fewer than `views` keyframes show it; no keyframe shows one that was made on the spot.
FrameMatches SplitMatches(const MapSnapshot& snapshot, int views, LandmarkMatches& association);

// Copies the matches of `from` for those features that have none in `to`. The candidates of both
// must be the same.
void MergeMatches(const FrameMatches& from, FrameMatches& to);

// Counts the features that have a match in both.
int CommonMatches(const FrameMatches& a, const FrameMatches& b);

// The landmarks of the map that were projected into the image, and so are expected to be seen.
struct ExpectedLandmarks {
  std::vector<PointId> points;  // ascending
  std::vector<LineId> lines;    // ascending
};

// Writes into a frame which landmarks of the map its features show. Features without a match, or
// matched with a landmark that was made on the spot, show none.
void SetLandmarks(const LandmarkMatches& association, Frame& frame);

// Adds to the scores of the map's landmarks: one for each that was expected to be seen, and one for
// each that was found.
void CountSeen(const ExpectedLandmarks& expected,
               const LandmarkMatches& association,
               TrackingScores& scores);

// Projects the candidates with the given pose and matches those without a match with the features
// without a match.
void MatchCandidates(const CameraAndPyramid& imaging,
                     const FrameFeatures& image,
                     const Rigid3& cam_from_world,
                     const ProjectionSearchOptions& options,
                     LandmarkMatches& association);

// Projects the landmarks of the snapshot with the given pose and matches those without a match with
// the features without a match. Only those that are matched become candidates, since a frame shows
// few of the thousands of landmarks that a snapshot has. Returns all that should be visible,
// matched or not.
ExpectedLandmarks MatchSnapshot(const CameraAndPyramid& imaging,
                                const FrameFeatures& image,
                                const Rigid3& cam_from_world,
                                const ProjectionSearchOptions& options,
                                const MapSnapshot& snapshot,
                                LandmarkMatches& association);

}  // namespace plumbline
