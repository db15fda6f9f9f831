// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/pose_search.h"

#include <cstddef>
#include <optional>
#include <span>

namespace plumbline {

// A frame whose pose in the map was found by appearance.
struct Relocalized {
  Frame frame;  // the frame with its pose
  LandmarkMatches association;
  KeyFrameId keyframe;  // the candidate that it was found from
  FrameCounts counts;
  double scene_depth = 0;  // median depth of the inliers

  int Inliers() const { return counts.inlier_points + counts.inlier_lines; }
};

// A keyframe that may show the place of a frame, and the map that has this keyframe (not owned).
struct PlaceToTry {
  const Map* map = nullptr;
  KeyFrameId keyframe;
};

// Finds the pose of a frame in one of some maps by appearance alone.
//
// The caller names keyframes that may show the place, from an index of places. The first few that
// show different surroundings are tried. Each gives the pose that most matches agree with
// (PoseFromPoints); from there the landmarks around that keyframe are searched. Where two places
// explain the image nearly as well, neither is believed.
//
// Thread-safe; the result depends on the arguments alone. Cost: some tens of milliseconds.
class Relocalizer {
 public:
  Relocalizer(const CameraAndPyramid& imaging,
              const TrackingOptions& tracking,
              const PoseEstimator& estimator);

  // More candidates than this are of no use, since not all of them are tried.
  static constexpr std::size_t kCandidates = 20;

  // Finds the pose of a frame from `candidates`, which are ordered by likeness, the most alike
  // first, and may be of several maps of one atlas. Candidates that their map does not have are
  // passed over. The frame's pose and matches are not looked at. Two maps count as two places, even
  // where nobody knows yet that they show the same.
  std::optional<Relocalized> Find(const Frame& frame, std::span<const PlaceToTry> candidates) const;

 private:
  std::optional<Relocalized> FindBeside(const PlaceToTry& place, const Frame& frame) const;

  PoseSearch search_;
};

}  // namespace plumbline
