// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/base/options.h"
#include "plumbline/optimization/pose_only.h"
#include "plumbline/tracking/keyframe_policy.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// What a frame is tracked against.
enum class TrackingReference { kLocalMap, kLastFrame };
constexpr auto EnumNames(std::type_identity<TrackingReference>) {
  return std::array{std::pair{TrackingReference::kLocalMap, "local_map"},
                    std::pair{TrackingReference::kLastFrame, "last_frame"}};
}

struct TrackingOptions {
  TrackingReference reference = TrackingReference::kLocalMap;
  // Fewest points and lines that a pose needs: one near the predicted pose, and one without
  // prediction.
  int min_inliers = 4;
  int min_unpredicted_inliers = 10;
  // A pose with fewer points and lines than these needs this part of the matched points.
  int sure_inliers = 30;
  double min_inlier_ratio = 0.4;
  // A pose is accepted when its deviations (PoseSigma) are at most this.
  double max_pose_sigma = 0.02;
  // No landmarks of uncertain depth are searched for a pose that is known so well by so many.
  double enough_pose_sigma = 0.002;
  int enough_inliers = 60;
  // No lines at a guessed depth are searched for a pose that is known so well.
  double guess_pose_sigma = 0.01;
  // Landmarks that so many keyframes show are not outvoted by others.
  int established_views = 3;
  double motion_sigma = 5;  // change of the velocity [rad/s^2], [scene depths/s^2]
  int min_initial = 60;     // points with depth + lines with depth that can start a map
  double max_relative_depth_sigma = 0.05;       // of points made from one frame
  double max_relative_line_depth_sigma = 0.15;  // of the ends of lines, whose weights allow for it
  double worst_relative_depth_sigma = 0.3;      // the same when the first search finds too little
  double close_relative_depth_sigma = 0.05;     // of points that count as near
  bool point_covariance = true;  // what the depths of such points leave open counts in the pose
  double first_radius_px = 12;   // search around the predicted place, from the last frame
  double wide_factor = 3;        // the same when that finds too little
  int new_map_after = 10;        // lost frames after which a new map starts
  int trial_keyframes = 5;       // until then a map of a single camera is given up at once
  ProjectionSearchOptions search;
  PoseOnlyOptions pose;
  KeyFramePolicyOptions keyframes;
};

// Which poses are accepted: a part of the fields.
template <class Visitor>
void VisitAcceptance(Visitor& visit, TrackingOptions& o) {
  visit("min_inliers", o.min_inliers, "points + lines a pose needs to be accepted", Range{4, 1000});
  visit("min_unpredicted_inliers",
        o.min_unpredicted_inliers,
        "the same without a predicted pose to search from",
        Range{4, 1000});
  visit("sure_inliers",
        o.sure_inliers,
        "points + lines that agree with a pose, from which on any part of the matches may disagree",
        Range{0, 100000});
  visit("min_inlier_ratio",
        o.min_inlier_ratio,
        "part of the matched points that must agree with a pose of fewer",
        Range{0, 1});
  visit(
      "max_pose_sigma",
      o.max_pose_sigma,
      "deviation to which they, and the motion before, must fix it: rotation [rad] and translation "
      "relative to the depth of the scene",
      Range{1e-6, 10});
  visit("enough_pose_sigma",
        o.enough_pose_sigma,
        "the same, from which on no landmarks of more uncertain depth are searched",
        Range{1e-6, 10});
  visit("enough_inliers",
        o.enough_inliers,
        "points + lines that agree with it, below which they are searched all the same",
        Range{0, 100000});
  visit("guess_pose_sigma",
        o.guess_pose_sigma,
        "the same, up to which no lines without known depth are searched",
        Range{1e-6, 10});
  visit("established_views",
        o.established_views,
        "keyframes that show an established landmark: where these fix the pose to "
        "enough_pose_sigma, others cannot outvote them; 0: all count alike",
        Range{0, 1000});
}

// Which depths are used: a part of the fields.
template <class Visitor>
void VisitDepthSigmas(Visitor& visit, TrackingOptions& o) {
  visit("max_relative_depth_sigma",
        o.max_relative_depth_sigma,
        "depth uncertainty of points from one frame, relative to depth",
        Range{0.001, 1});
  visit("max_relative_line_depth_sigma",
        o.max_relative_line_depth_sigma,
        "the same for the ends of lines",
        Range{0.001, 1});
  visit("worst_relative_depth_sigma",
        o.worst_relative_depth_sigma,
        "the same when the first search finds too little",
        Range{0.001, 1});
  visit("close_relative_depth_sigma",
        o.close_relative_depth_sigma,
        "depth uncertainty below which a point counts as near, relative to depth",
        Range{0.001, 1});
  visit("point_covariance",
        o.point_covariance,
        "points made from one frame weigh in the pose as the uncertainty of their place says (with "
        "local_map not in the first search, which uses well-known depths only)");
}

template <class Visitor>
void VisitFields(Visitor&& visit, TrackingOptions& o) {
  visit(
      "reference",
      o.reference,
      "what a frame is tracked against: local_map, or last_frame (odometry: points and lines with "
      "depth of the frame before alone, only the first frame becomes a keyframe; needs depth)");
  VisitAcceptance(visit, o);
  visit("motion_sigma",
        o.motion_sigma,
        "change of velocity that the prediction allows for: rotation [rad/s^2] and translation "
        "[scene depths/s^2]",
        Range{0.01, 1000});
  visit("min_initial", o.min_initial, "points + lines with depth to start a map", Range{10, 10000});
  VisitDepthSigmas(visit, o);
  visit("first_radius_px",
        o.first_radius_px,
        "search radius from the last frame [px]",
        Range{1, 200});
  visit(
      "wide_factor", o.wide_factor, "larger search when the first finds too little", Range{1, 20});
  visit("new_map_after",
        o.new_map_after,
        "lost frames after which a new map starts",
        Range{1, 100000});
  visit("trial_keyframes",
        o.trial_keyframes,
        "keyframes after the start from a single camera until which one lost frame ends the map",
        Range{0, 100});
  visit("search", o.search, "search of landmarks in the image");
  visit("pose", o.pose, "pose from matches");
  visit("keyframes", o.keyframes, "when a frame becomes a keyframe");
}

}  // namespace plumbline
