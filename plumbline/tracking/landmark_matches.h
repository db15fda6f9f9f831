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

// A landmark that a frame may show: one of the map, or, with an invalid id, a temporary one made
// from the depths of one frame.
struct PointCandidate {
  PointId id;
  PointModel model;
  // Covariance of the position in the world; zero if the position counts as exact. A line has its
  // covariance in its model.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
// A line that a frame may show, with a valid or an invalid id as PointCandidate.
struct LineCandidate {
  LineId id;
  LineModel model;
};

// Match of each feature of a frame: an index into the candidates, or -1 for none.
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

// Landmarks that a frame may show, and the matches of its features with them.
struct LandmarkMatches {
  std::vector<PointCandidate> points;
  std::vector<LineCandidate> lines;
  FrameMatches matches;  // indices refer to these points and lines
  // Pose of the frame whose depths gave the temporary landmarks; nullopt if there are none.
  std::optional<Rigid3> made_from;

  LandmarkMatches() = default;
  // No candidates and no matches.
  LandmarkMatches(std::size_t point_features, std::size_t line_features)
      : matches(point_features, line_features) {}
};

// Returns the matches of a frame of the map with landmarks of the snapshot.
LandmarkMatches AssociationOf(const Frame& frame, const MapSnapshot& snapshot);

// Counts the matches with landmarks of the map.
int MatchesOfMap(const LandmarkMatches& association);

// Copies matches of features unmatched in `to`: those with landmarks of the map if `of_map`,
// otherwise those with temporary landmarks.
void CopyMatches(const LandmarkMatches& from, bool of_map, LandmarkMatches& to);

// Removes the matches with recent landmarks from an association and returns them. A landmark is
// recent if fewer than `views` keyframes observe it; temporary landmarks have no such keyframe.
FrameMatches SplitMatches(const MapSnapshot& snapshot, int views, LandmarkMatches& association);

// Copies the matches of `from` for features unmatched in `to`. The candidates of both must be the
// same.
void MergeMatches(const FrameMatches& from, FrameMatches& to);

// Counts the features that have a match in both.
int CommonMatches(const FrameMatches& a, const FrameMatches& b);

// Sets the landmark of each feature of a frame to its match. Features without a match, or matched
// with a temporary landmark, get none.
void SetLandmarks(const LandmarkMatches& association, Frame& frame);

// Updates the scores of the map's landmarks: counts each expected landmark as visible, and each
// matched one as found.
void CountSeen(const LandmarkIds& expected,
               const LandmarkMatches& association,
               TrackingScores& scores);

// Projects the candidates with the given pose and matches unmatched ones with unmatched features.
void MatchCandidates(const CameraAndPyramid& imaging,
                     const FrameFeatures& image,
                     const Rigid3& cam_from_world,
                     const ProjectionSearchOptions& options,
                     LandmarkMatches& association);

// Projects the landmarks of the snapshot with the given pose and matches unmatched ones with
// unmatched features. Only matched ones become candidates, since a frame shows few of the thousands
// of landmarks of a snapshot. Returns all that should be visible, matched or not, ascending.
LandmarkIds MatchSnapshot(const CameraAndPyramid& imaging,
                          const FrameFeatures& image,
                          const Rigid3& cam_from_world,
                          const ProjectionSearchOptions& options,
                          const MapSnapshot& snapshot,
                          LandmarkMatches& association);

}  // namespace plumbline
