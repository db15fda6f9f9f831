// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/measurements.h"
#include "plumbline/association/projection_search.h"
#include "plumbline/base/options.h"
#include "plumbline/cutting/cut_lines.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/optimization/pose_only.h"
#include "plumbline/tracking/frame_association.h"
#include "plumbline/tracking/keyframe_policy.h"
#include "plumbline/tracking/pose_estimation.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// What a frame is tracked against.
enum class TrackingReference { kLocalMap, kLastFrame };
constexpr auto EnumNames(std::type_identity<TrackingReference>) {
  return std::array{std::pair{TrackingReference::kLocalMap, "local_map"},
                    std::pair{TrackingReference::kLastFrame, "last_frame"}};
}

struct TrackingOptions {
  TrackingReference reference = TrackingReference::kLocalMap;
  int min_inliers = 4;               // points + lines a pose near the predicted one needs ...
  int min_unpredicted_inliers = 10;  // ... and one without prediction
  double max_pose_sigma = 0.02;      // and to which they must fix it (PoseSigma)
  double enough_pose_sigma = 0.002;  // from which on no more uncertain landmarks are tried
  double guess_pose_sigma = 0.01;    // up to which lines at the depth of the scene are not tried
  int established_views = 3;         // keyframes that show a landmark which others cannot outvote
  double motion_sigma = 5;           // change of the velocity [rad/s^2], [scene depths/s^2]
  int min_initial = 60;              // points with depth + lines with depth that can start a map
  double max_relative_depth_sigma = 0.05;       // of points made from one frame
  double max_relative_line_depth_sigma = 0.15;  // of the ends of lines, whose weights allow for it
  double worst_relative_depth_sigma = 0.3;      // the same when the first search finds too little
  double close_relative_depth_sigma = 0.05;     // of points that count as near
  double first_radius_px = 12;  // search around the predicted place, from the last frame
  double wide_factor = 3;       // the same when that finds too little
  int new_map_after = 10;       // lost frames after which a new map starts
  int trial_keyframes = 5;      // until then a map of a single camera is given up at once
  ProjectionSearchOptions search;
  PoseOnlyOptions pose;
  KeyFramePolicyOptions keyframes;
};

template <class Visitor>
void VisitFields(Visitor&& visit, TrackingOptions& o) {
  visit(
      "reference",
      o.reference,
      "what a frame is tracked against: local_map, or last_frame (odometry: points and lines with "
      "depth of the frame before alone, only the first frame becomes a keyframe; needs depth)");
  visit("min_inliers", o.min_inliers, "points + lines a pose needs to be accepted", Range{4, 1000});
  visit("min_unpredicted_inliers",
        o.min_unpredicted_inliers,
        "the same without a predicted pose to search from",
        Range{4, 1000});
  visit("max_pose_sigma",
        o.max_pose_sigma,
        "deviation to which they must fix it: rotation [rad] and translation relative to the depth "
        "of the scene",
        Range{1e-6, 10});
  visit("enough_pose_sigma",
        o.enough_pose_sigma,
        "the same, from which on no landmarks of more uncertain depth are searched",
        Range{1e-6, 10});
  visit("guess_pose_sigma",
        o.guess_pose_sigma,
        "the same, up to which no lines without known depth are searched",
        Range{1e-6, 10});
  visit("established_views",
        o.established_views,
        "keyframes that show an established landmark: where these fix the pose to "
        "enough_pose_sigma, others cannot outvote them; 0: all count alike",
        Range{0, 1000});
  visit("motion_sigma",
        o.motion_sigma,
        "change of velocity that the prediction allows for: rotation [rad/s^2] and translation "
        "[scene depths/s^2]",
        Range{0.01, 1000});
  visit("min_initial", o.min_initial, "points + lines with depth to start a map", Range{10, 10000});
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

enum class TrackerState { kInitializing, kTracking, kLost };
constexpr auto EnumNames(std::type_identity<TrackerState>) {
  return std::array{std::pair{TrackerState::kInitializing, "initializing"},
                    std::pair{TrackerState::kTracking, "tracking"},
                    std::pair{TrackerState::kLost, "lost"}};
}

// Why a frame has no pose.
enum class TrackingFailure {
  kNone,
  kTooFewFeatures,    // to start a map
  kTooFewMatches,     // landmarks found in the image
  kTooFewInliers,     // of them agree on a pose
  kPoseNotObservable  // the inliers do not fix all six degrees of freedom
};
constexpr auto EnumNames(std::type_identity<TrackingFailure>) {
  return std::array{std::pair{TrackingFailure::kNone, ""},
                    std::pair{TrackingFailure::kTooFewFeatures, "too_few_features"},
                    std::pair{TrackingFailure::kTooFewMatches, "too_few_matches"},
                    std::pair{TrackingFailure::kTooFewInliers, "too_few_inliers"},
                    std::pair{TrackingFailure::kPoseNotObservable, "pose_not_observable"}};
}

// The next state after a frame. With too many lost frames in a row a new map is to be started.
TrackerState NextState(TrackerState state, bool has_pose, int lost_frames, int new_map_after);

struct NewKeyFrame {
  KeyFrame keyframe;
  KeyFrameReason reason = KeyFrameReason::kNone;  // kNone: the first of a map
  TrackingScores scores;
};

struct FrameCounts {
  int matched_points = 0, matched_lines = 0;
  int inlier_points = 0, inlier_lines = 0;
};

struct TrackingResult {
  TrackerState state = TrackerState::kInitializing;  // after this frame
  TrackingFailure failure = TrackingFailure::kNone;
  FrameCounts counts;
  std::optional<Rigid3> cam_from_world;  // where the frame has a pose
  KeyFrameId reference;                  // the keyframe it moves with from now on
  Rigid3 cam_from_reference;
  std::optional<NewKeyFrame> keyframe;
  bool starts_map = false;  // the keyframe is the first of a new map
  Frame frame;              // as tracked: features, and matches where it has a pose
};

// Follows the camera: one frame after the other against an immutable snapshot of the map.
//
// Prediction by constant velocity; landmarks of the last frame (and points and lines with depth
// that are not in the map yet) are searched near their predicted places, then the rest of the
// snapshot; pose from points and lines together after each. When the prediction fails, by
// appearance against the snapshot's keyframe.
//
// With TrackingReference::kLastFrame the last frame stands for the map: points and lines made from
// its depths alone, as stereo odometry does (PL-SLAM of Gomez-Ojeda et al., the second paper's
// setting). Nothing is kept: the only keyframe is the first frame, which poses refer to. Needs a
// camera that measures depth.
class Tracker {
 public:
  // world_from_first_cam: pose given to the first frame of each map.
  Tracker(const ImagingModel& imaging,
          const TrackingOptions& options,
          const LineOptions& lines,
          const CuttingOptions& cutting,
          const Rigid3& world_from_first_cam);

  // snapshot: null exactly while the tracker has no map. mapping_behind: make no keyframe that
  // can be done without.
  TrackingResult Track(FrameId id,
                       std::int64_t stamp_ns,
                       std::shared_ptr<const IndexedFeatures> indexed,
                       const MapSnapshot* snapshot,
                       bool mapping_behind = false);

  // Begins to follow a map that was made of several frames: the snapshot is centred on its newest
  // keyframe, which is made of the frame of today.
  //   velocity  of the camera there, as a left tangent per second
  TrackingResult StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity);

  TrackerState state() const { return state_; }
  // The id that the next keyframe will get.
  KeyFrameId next_keyframe() const { return next_keyframe_; }

 private:
  struct LastFrame {
    Frame frame;
    FrameAssociation association;
    KeyFrameId reference;
    Rigid3 cam_from_reference;
  };

  TrackingResult StartMap(Frame frame);
  TrackingResult Follow(Frame frame, const MapSnapshot& snapshot, bool mapping_behind);
  Rigid3 LastPose(const MapSnapshot& snapshot) const;
  // No information where the velocity is not known.
  PosePrior Predict(const Rigid3& last_pose, double seconds) const;
  // Which new landmarks are made from the last frame's depths: those that it knows well, also those
  // that it hardly knows, also lines at the depth of the scene.
  enum class Depths { kKnown, kUncertain, kGuessed };
  struct LastSearch {
    Depths depths = Depths::kKnown;
    double factor = 1;  // of the usual distance from the predicted places
  };
  FrameAssociation LastLandmarks(const MapSnapshot& snapshot,
                                 const Frame& frame,
                                 Depths depths) const;
  std::optional<PoseEstimate> SearchLast(const Frame& frame,
                                         const PosePrior& predicted,
                                         const MapSnapshot& snapshot,
                                         const LastSearch& how,
                                         FrameAssociation& association) const;
  std::optional<PoseEstimate> FromPrediction(const Frame& frame,
                                             const PosePrior& predicted,
                                             const MapSnapshot& snapshot,
                                             FrameAssociation& association) const;
  // What a feature of the frame to match by appearance shows: of the map, or, with odometry, made
  // from its depth.
  std::optional<CandidatePoint> PointOf(const Frame& frame,
                                        std::size_t feature,
                                        const MapSnapshot& snapshot) const;
  std::optional<CandidateLine> LineOf(const Frame& frame,
                                      std::size_t feature,
                                      const MapSnapshot& snapshot) const;
  std::optional<PoseEstimate> FromAppearance(const Frame& frame,
                                             const Rigid3& initial,
                                             const MapSnapshot& snapshot,
                                             FrameAssociation& association,
                                             FrameCounts& counts) const;
  // Searches more of the last frame's landmarks from the first estimate.
  PoseEstimate WithLastFrame(const Frame& frame,
                             const PoseEstimate& first,
                             const PosePrior& prior,
                             FrameAssociation& association,
                             FrameCounts& counts) const;
  // Things that move make new landmarks all the time; near the camera, whose disparities say most,
  // they outvote walls that have been known for long. Where the pose from all matches loses some of
  // the established landmarks, which fix the pose without the others and agree among themselves,
  // they decide, and the others count as far as they agree.
  PoseEstimate EstimateNotOutvoted(const Frame& frame,
                                   const Rigid3& initial,
                                   const PosePrior& prior,
                                   const MapSnapshot& snapshot,
                                   FrameAssociation& association) const;
  PoseEstimate WithLocalMap(const Frame& frame,
                            const PoseEstimate& first,
                            const PosePrior& prior,
                            const MapSnapshot& snapshot,
                            FrameAssociation& association,
                            FrameCounts& counts);
  PoseEstimate Estimate(const Frame& frame,
                        const Rigid3& initial,
                        const PosePrior& prior,
                        FrameAssociation& association) const;
  bool Accepted(const PoseEstimate& pose) const {
    return pose.Accepted(options_.min_inliers, options_.max_pose_sigma);
  }
  void Score(const ExpectedLandmarks& expected, const FrameAssociation& association);
  KeyFrameSituation Situation(const Frame& frame,
                              const FrameAssociation& association,
                              const MapSnapshot& snapshot) const;
  TrackingResult Fail(Frame frame, TrackingFailure failure, FrameCounts counts);
  NewKeyFrame MakeKeyFrame(const Frame& frame, KeyFrameId parent, KeyFrameReason reason);

  ImagingModel imaging_;
  TrackingOptions options_;
  LineOptions lines_;
  CuttingOptions cutting_;
  Rigid3 first_cam_from_world_;
  TrackerState state_ = TrackerState::kInitializing;
  std::optional<LastFrame> last_;
  Vector6d velocity_ = Vector6d::Zero();  // left tangent of the camera motion, per second
  // How well the last pose is known, where the velocity is.
  struct Spread {
    Matrix6d covariance;
    double scene_depth = 0;
  };
  std::optional<Spread> spread_;
  TrackingScores scores_;
  KeyFrameId next_keyframe_{0};
  KeyFrameId newest_keyframe_;
  std::int64_t frames_since_keyframe_ = 0;
  int lost_frames_ = 0;
  int trial_keyframes_ = 0;  // still to come until the map is trusted
};

}  // namespace plumbline
