// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/pyramid.h"
#include "plumbline/inertial/gyroscope.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/keyframe_pose.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/keyframe_decision.h"
#include "plumbline/tracking/motion_model.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/pose_estimation.h"
#include "plumbline/tracking/pose_search.h"
#include "plumbline/tracking/relocalization.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// State of the tracker: no map yet, tracking, or lost.
enum class TrackerState { kInitializing, kTracking, kLost };

// Reason why a frame has no pose.
enum class TrackingFailure {
  kNone,
  kTooFewFeatures,     // the image shows too little for a pose, or too little with depth (stereo,
                       // RGB-D) to start a map
  kNotRelocalized,     // lost, and not relocalized yet
  kTooFewMatches,      // too few landmarks were matched
  kTooFewInliers,      // too few of the matches agree on a pose
  kPoseNotObservable,  // the inliers do not determine the pose to max_pose_sigma
  kMapWithdrawn        // the map proved wrong (MapSnapshot::withdrawn)
};
constexpr auto EnumNames(std::type_identity<TrackingFailure>) {
  return std::array{std::pair{TrackingFailure::kNone, ""},
                    std::pair{TrackingFailure::kTooFewFeatures, "too_few_features"},
                    std::pair{TrackingFailure::kNotRelocalized, "not_relocalized"},
                    std::pair{TrackingFailure::kTooFewMatches, "too_few_matches"},
                    std::pair{TrackingFailure::kTooFewInliers, "too_few_inliers"},
                    std::pair{TrackingFailure::kPoseNotObservable, "pose_not_observable"},
                    std::pair{TrackingFailure::kMapWithdrawn, "map_withdrawn"}};
}

// Returns the state after a frame. After too many lost frames in a row a new map starts.
TrackerState NextState(TrackerState state, bool has_pose, int lost_frames, int new_map_after);

// A keyframe as made by the tracker. Its pose is relative to its parent in the snapshot that it was
// tracked against; mapping may have moved the parent before it inserts the keyframe.
struct NewKeyFrame {
  KeyFrame keyframe;
  TrackingScores scores;
  RelativePose from_parent = {};  // used only with a parent
  // Pyramid of the rectified left image, if mapping aligns points in it (PointAligner); else null.
  std::shared_ptr<const ImagePyramid> left_pyramid = nullptr;
};

// Use of a map from an earlier run.
struct MapUse {
  KeyFrameId next_keyframe;  // the first id unused in the map
  bool read_only = false;    // make no keyframes and start no map, however long the camera is lost
  int patience = 200;        // lost frames after which another map starts
};

// Search time for a lost camera before another map may start, beyond tracking.new_map_after.
struct LossPatience {
  // Least time since the last pose. Does not apply to a map on trial or from an earlier run.
  double min_seconds = 0;
  // Frames that show too little for a pose (a covered lens, darkness) and do not count as lost.
  // After one of them, no map starts before relocalization was tried for a frame that shows more
  // (NotFound).
  int blind_frames = 0;
};

// Result of Tracker::Track.
struct TrackingResult {
  TrackerState state = TrackerState::kInitializing;  // state after this frame
  TrackingFailure failure = TrackingFailure::kNone;
  FrameCounts counts;
  std::optional<Rigid3> cam_from_world;  // nullopt if tracking failed
  // Covariance of the left perturbation [rotation, translation] of cam_from_world, by the inliers
  // and the motion so far, relative to a map that counts as exact (except the depths of points from
  // a single frame, if TrackingOptions::point_covariance is on). Nullopt if the pose was not
  // estimated from matches: that of a first frame is chosen, that of a monocular start is adjusted
  // with its map.
  std::optional<Matrix6d> covariance;
  KeyFrameId reference;  // reference keyframe of the pose
  RelativePose from_reference;
  std::optional<NewKeyFrame> keyframe;
  bool starts_map = false;  // the keyframe is the first of a new map
  // True if the camera leaves the area of the snapshot, so that a new one is needed around it. Set
  // only in a read-only map, for a frame that would otherwise become a keyframe.
  bool leaves_surroundings = false;
  Frame frame;  // the frame as tracked: features, and its matches if it has a pose
};

// Follows the camera: tracks one frame after the other against an immutable snapshot of the map.
//
// The pose is predicted by constant velocity, its rotation by a gyroscope if there is one (Use),
// also of frames after lost ones. Landmarks of the last frame (and points and lines
// with depth that are not in the map yet) are searched near their predicted places, then the rest
// of the snapshot is searched; after each search the pose is estimated from points and lines
// together. When the prediction fails, the frame is matched by appearance with the snapshot's
// keyframe.
//
// With TrackingReference::kLastFrame the last frame replaces the map: only points and lines made
// from its depths are used, as in stereo odometry (PL-SLAM of Gomez-Ojeda et al., the second
// paper's setting). No landmarks are stored. The first frame is the only keyframe, to which all
// poses refer. This needs a camera that measures depth.
class Tracker {
 public:
  // world_from_first_cam  pose given to the first frame of each map
  Tracker(const CameraAndPyramid& imaging,
          const TrackingOptions& options,
          const PoseEstimator& estimator,
          const Rigid3& world_from_first_cam,
          const LossPatience& loss = {});

  // Tracks a frame. `snapshot` is null exactly while the tracker has no map. The snapshot of a
  // withdrawn map ends that map: the frame has no pose, and the next frames begin another map.
  // `feature_share` is the share of the usual number of features that was extracted (live runs).
  TrackingResult Track(FrameId id,
                       std::int64_t stamp_ns,
                       std::shared_ptr<const FrameFeatures> indexed,
                       const MapSnapshot* snapshot,
                       double feature_share = 1);

  // Returns true if the next frame needs the positions of its lines in the right image before
  // tracking, which ExtractFeatures leaves out. A frame that starts a map, or replaces it
  // (TrackingReference::kLastFrame), makes landmarks of its lines. If the last pose is less certain
  // than usual, the next frame needs all information of its lines.
  bool NeedsRightLines() const;
  // Returns true if the lines of the last frame, whose result is given, become landmarks: the frame
  // became a keyframe, or its pose is less certain than usual, so that the next frame has to be
  // tracked by its lines.
  bool WantsRightLines(const TrackingResult& result) const;
  // Replaces the features of the last frame, its result and its keyframe by features with right
  // lines.
  void Complete(const std::shared_ptr<const FrameFeatures>& whole, TrackingResult& result);

  // Begins to track a map made of several frames. The snapshot is centred on its newest keyframe,
  // which is made of the present frame.
  //   velocity  of the camera there, as a left tangent per second
  TrackingResult StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity);

  // Begins lost in a map of an earlier run, and relocalizes for as long as `use` allows.
  void BeginLost(const MapUse& use);
  // Continues, after being lost, from a relocalized frame. `snapshot` is taken around the candidate
  // from which its pose was found.
  void FollowFrom(const Relocalized& found, const MapSnapshot& snapshot);
  // Predicts the turns of the camera by a gyroscope from now on, which learns from the poses. It
  // must outlive this object.
  void Use(Gyroscope& gyroscope) { gyroscope_ = &gyroscope; }
  // Reports a failed relocalization of a lost frame.
  void NotFound() { asked_ = true; }
  // Handles a removed keyframe: poses that refer to it refer to its parent from now on.
  void ReparentPoses(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);

  TrackerState state() const { return state_; }
  // Returns the id that the next keyframe will get.
  KeyFrameId next_keyframe() const { return next_keyframe_; }
  // Returns true if there is a last pose, so that the next frame needs a snapshot.
  bool follows() const { return last_.has_value(); }

 private:
  // Returns true if the last frame replaces the map.
  bool IsOdometry() const { return options_.reference == TrackingReference::kLastFrame; }

  // The reference keyframe of the last pose.
  struct Anchor {
    KeyFrameId keyframe;
    RelativePose relative;
  };
  struct Tracked : LastFrame {
    Anchor anchor;
    // Used while the frame itself is a keyframe not yet in the map.
    Anchor parent;
  };

  // A pose, or the reason why there is none.
  struct PoseCandidate {
    std::optional<PoseAttempt> attempt;
    TrackingFailure failure = TrackingFailure::kNone;
    FrameCounts counts;  // of this attempt
  };

  // Where the frame is expected, and by what.
  struct Prediction {
    PosePrior prior;
    double window = 1;                   // times the usual radius of the first search
    std::optional<CameraTurn> turn;      // since the last pose, if the gyroscope measured it
    std::optional<Matrix6d> covariance;  // of prior's pose, if the turn is part of it
  };
  Prediction Predict(const Rigid3& last_pose, std::int64_t stamp_ns, double seconds);
  // Lets the gyroscope learn from a pose.
  void Teach(const Prediction& predicted,
             const Rigid3& last_pose,
             const std::optional<Matrix6d>& last_covariance,
             const PoseAttempt& attempt,
             double seconds);

  // Tracks a frame against a map: predicts the pose, estimates it, decides about a keyframe.
  TrackingResult TrackInMap(Frame frame, const MapSnapshot& map, double feature_share);
  std::optional<PoseAttempt> TrackWithMotionModel(const Frame& frame,
                                                  const Prediction& predicted,
                                                  const MapSnapshot& snapshot) const;
  std::optional<PoseAttempt> TrackReferenceKeyFrame(const Frame& frame,
                                                    const MapSnapshot& snapshot,
                                                    FrameCounts& counts) const;
  PoseAttempt TrackLocalMap(const Frame& frame,
                            const PoseEstimate& first,
                            const PosePrior& prior,
                            const MapSnapshot& snapshot,
                            LandmarkMatches found) const;
  bool IsWeak(const PoseAttempt& attempt) const;
  // without_pose: counts of matches to report without an attempt.
  PoseCandidate CheckPose(std::optional<PoseAttempt> attempt,
                          const FrameCounts& without_pose) const;
  bool NeedsKeyFrame(const Frame& frame,
                     const LandmarkMatches& association,
                     const MapSnapshot& snapshot,
                     double feature_share) const;

  // The pose refers to the centre of the snapshot, the reference keyframe.
  TrackingResult FinishTracked(Frame frame,
                               PoseCandidate pose,
                               const MapSnapshot& map,
                               bool needs_keyframe);
  TrackingResult FinishLost(Frame frame, TrackingFailure failure, FrameCounts counts);
  bool IsBlind(const Features& features) const;
  int Patience(const Frame& frame, bool blind) const;
  void ForgetLoss();
  TrackingResult StartMap(Frame frame);
  NewKeyFrame MakeKeyFrame(const Frame& frame, KeyFrameId parent, const RelativePose& from_parent);
  void UpdateLastFrame(const MapSnapshot& snapshot);

  TrackingOptions options_;
  PoseSearch search_;
  double focal_;  // pixels
  bool monocular_;
  Gyroscope* gyroscope_ = nullptr;  // null if there is none
  Rigid3 first_cam_from_world_;
  LossPatience loss_;
  TrackerState state_ = TrackerState::kInitializing;
  std::optional<Tracked> last_;
  MotionModel motion_;
  TrackingScores scores_;
  KeyFrameId next_keyframe_{0};
  KeyFrameId newest_keyframe_;
  std::int64_t frames_since_keyframe_ = 0;
  int lost_frames_ = 0;
  int blind_frames_ = 0;       // since the last pose, at most LossPatience::blind_frames
  bool asked_ = false;         // a frame after the last blind one was not found
  std::optional<MapUse> use_;  // set in a map of an earlier run
  int trial_keyframes_ = 0;    // keyframes still to come until the map is trusted
};

}  // namespace plumbline
