// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/tracking/keyframe_decision.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// Whether a frame is tracked against the map or against the last frame alone.
enum class TrackingReference { kLocalMap, kLastFrame };
constexpr auto EnumNames(std::type_identity<TrackingReference>) {
  return std::array{std::pair{TrackingReference::kLocalMap, "local_map"},
                    std::pair{TrackingReference::kLastFrame, "last_frame"}};
}

struct TrackingOptions {
  TrackingReference reference = TrackingReference::kLocalMap;
  // A pose is accepted when its deviations (PoseUncertainty) are at most this.
  double max_pose_sigma = 0.02;
  // A pose that is known this well, from enough_inliers inliers, needs no landmarks of uncertain
  // depth.
  double enough_pose_sigma = 0.002;
  int enough_inliers = 60;
  // A landmark that so many keyframes show is established: younger ones cannot outvote it.
  int established_views = 3;
  int min_initial = 60;          // points plus lines with depth that are enough to start a map
  bool point_covariance = true;  // whether the pose counts the uncertainty of depths from one frame
  int new_map_after = 10;        // a new map starts after so many lost frames
  // A map of a single camera is given up as soon as it loses the camera, until it has so many
  // keyframes more than at its start.
  int trial_keyframes = 5;
  KeyFramePolicyOptions keyframes;
};

template <class Visitor>
void VisitFields(Visitor&& visit, TrackingOptions& o) {
  visit(
      "reference",
      o.reference,
      "what a frame is tracked against: local_map, or last_frame (odometry: points and lines with "
      "depth of the frame before alone, only the first frame becomes a keyframe; needs depth)");
  visit("max_pose_sigma",
        o.max_pose_sigma,
        "deviation to which points and lines, and the motion before, must fix a pose: rotation "
        "[rad] and translation relative to the depth of the scene",
        Range{1e-6, 10});
  visit("enough_pose_sigma",
        o.enough_pose_sigma,
        "the same, from which on no landmarks of more uncertain depth are searched",
        Range{1e-6, 10});
  visit("enough_inliers",
        o.enough_inliers,
        "points + lines that agree with it, below which they are searched all the same",
        Range{0, 100000});
  visit("established_views",
        o.established_views,
        "keyframes that show an established landmark: where these fix the pose to "
        "enough_pose_sigma, others cannot outvote them; 0: all count alike",
        Range{0, 1000});
  visit("min_initial", o.min_initial, "points + lines with depth to start a map", Range{10, 10000});
  visit("point_covariance",
        o.point_covariance,
        "points made from one frame weigh in the pose as the uncertainty of their place says (with "
        "local_map not in the first search, which uses well-known depths only)");
  visit("new_map_after",
        o.new_map_after,
        "lost frames after which a new map starts",
        Range{1, 100000});
  visit("trial_keyframes",
        o.trial_keyframes,
        "keyframes after the start from a single camera until which one lost frame ends the map",
        Range{0, 100});
  visit("keyframes", o.keyframes, "when a frame becomes a keyframe");
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
