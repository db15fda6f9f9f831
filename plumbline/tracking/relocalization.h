// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/map.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/pose_search.h"

#include <cstddef>
#include <optional>
#include <span>

namespace plumbline {

// A frame with a pose found by appearance.
struct Relocalized {
  Frame frame;  // the frame with its pose
  LandmarkMatches association;
  KeyFrameId keyframe;  // candidate from which the pose was found
  FrameCounts counts;
  double scene_depth = 0;  // median depth of the inliers

  int Inliers() const { return counts.inlier_points + counts.inlier_lines; }
};

// A relocalization candidate: a keyframe, and its map (not owned).
struct PlaceToTry {
  const Map* map = nullptr;
  KeyFrameId keyframe;
};

// Finds the pose of a frame in one of several maps by appearance alone.
//
// The caller supplies candidate keyframes from a place index. The first few that show different
// areas are tried. Each gives the pose with most inliers (PoseFromPoints); from there the landmarks
// around that keyframe are searched. If two places explain the image nearly equally well, the
// result is empty.
//
// Thread-safe; the result depends on the arguments alone. Cost: some tens of milliseconds.
class Relocalizer {
 public:
  Relocalizer(const CameraAndPyramid& imaging,
              const TrackingOptions& tracking,
              const PoseEstimator& estimator);

  // Limit of useful candidates, since not all of them are tried.
  static constexpr std::size_t kCandidates = 20;

  // Finds the pose of a frame from `candidates`, ordered by similarity, the most similar first,
  // possibly of several maps of one atlas. Candidates that have left their map are skipped. The
  // frame's own pose and matches are not used. Two maps count as two places, even if they show the
  // same one.
  std::optional<Relocalized> Find(const Frame& frame, std::span<const PlaceToTry> candidates) const;
  // Finds the pose of a frame in a snapshot, from its centre as the only candidate.
  std::optional<Relocalized> Find(const Frame& frame, const MapSnapshot& snapshot) const;

 private:
  // The features are corrected as in the snapshot.
  std::optional<Relocalized> FindCorrected(const Frame& frame, const MapSnapshot& snapshot) const;

  PoseSearch search_;
};

}  // namespace plumbline
