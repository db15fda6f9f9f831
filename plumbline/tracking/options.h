// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Whether a frame is tracked against the map or against the last frame alone.
enum class TrackingReference { kLocalMap, kLastFrame };
constexpr auto EnumNames(std::type_identity<TrackingReference>) {
  return std::array{std::pair{TrackingReference::kLocalMap, "local_map"},
                    std::pair{TrackingReference::kLastFrame, "last_frame"}};
}

// Limits of the interval between keyframes.
struct KeyFramePolicyOptions {
  int max_frames = 20;  // a keyframe is made at the latest after this number of frames
  int min_frames = 2;   // no keyframe is made sooner, unless tracking is about to fail
};

template <class Visitor>
void VisitFields(Visitor&& visit, KeyFramePolicyOptions& o) {
  visit(
      "max_frames", o.max_frames, "a keyframe at the latest after so many frames", Range{1, 10000});
  visit("min_frames",
        o.min_frames,
        "frames after a keyframe until the next may come, unless tracking is about to fail; 1: the "
        "very next",
        Range{1, 1000});
}

struct TrackingOptions {
  TrackingReference reference = TrackingReference::kLocalMap;
  int min_initial = 60;    // points plus lines with depth that are enough to start a map
  int new_map_after = 10;  // a new map starts after so many lost frames
  KeyFramePolicyOptions keyframes;

  // The rest are no options of a run: constants, which tests set (docs/methods/tracking.md).

  // A pose is accepted when its deviations (PoseUncertainty) are at most this: rotation [rad], and
  // translation relative to the depth of the scene. With points they are 0.0003 or less.
  double max_pose_sigma = 0.02;
  // A pose that is known this well, from enough_inliers inliers, needs no landmarks of uncertain
  // depth. Twenty points and twenty lines can promise a good pose and still be wrong.
  double enough_pose_sigma = 0.002;
  int enough_inliers = 60;
  // A landmark that so many keyframes show is established: where these fix the pose to
  // enough_pose_sigma, younger ones cannot outvote them. 0: all count alike.
  int established_views = 3;
  bool point_covariance = true;  // whether the pose counts the uncertainty of depths from one frame
  // A map of a single camera is given up as soon as it loses the camera, until it has so many
  // keyframes more than at its start: a wrong start shows by then.
  int trial_keyframes = 5;
};

template <class Visitor>
void VisitFields(Visitor&& visit, TrackingOptions& o) {
  visit(
      "reference",
      o.reference,
      "what a frame is tracked against: local_map, or last_frame (odometry: points and lines with "
      "depth of the frame before alone, only the first frame becomes a keyframe; needs depth)");
  visit("min_initial", o.min_initial, "points + lines with depth to start a map", Range{10, 10000});
  visit("new_map_after",
        o.new_map_after,
        "lost frames after which a new map starts",
        Range{1, 100000});
  visit("keyframes", o.keyframes, "when a frame becomes a keyframe");
}

// Returns the options of 0.2.0 that are constants now, with their values.
inline std::vector<RemovedOption> RemovedOptions(std::type_identity<TrackingOptions>) {
  const TrackingOptions o;
  return {FixedAt("max_pose_sigma", o.max_pose_sigma, "TrackingOptions::max_pose_sigma"),
          FixedAt("enough_pose_sigma", o.enough_pose_sigma, "TrackingOptions::enough_pose_sigma"),
          FixedAt("enough_inliers", o.enough_inliers, "TrackingOptions::enough_inliers"),
          FixedAt("established_views", o.established_views, "TrackingOptions::established_views"),
          {"point_covariance", "it is fixed at true (TrackingOptions::point_covariance)", "true"},
          FixedAt("trial_keyframes", o.trial_keyframes, "TrackingOptions::trial_keyframes")};
}

// Whether, and for how long, a lost camera is looked for in its map.
struct RelocalizationOptions {
  bool enabled = true;
  // Lost frames in a map of an earlier run after which a new map starts; and in every map, frames
  // that show too little for a pose and do not count as lost.
  int patience = 200;
};

template <class Visitor>
void VisitFields(Visitor&& visit, RelocalizationOptions& o) {
  visit("enabled", o.enabled, "look for a lost camera in the map by what it shows");
  visit("patience",
        o.patience,
        "frames lost in the map of an earlier run after which a new map starts",
        Range{1, 1000000});
}

}  // namespace plumbline
