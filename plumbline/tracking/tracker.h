// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/pyramid.h"
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

// Whether the tracker has no map yet, follows the camera, or has lost it.
enum class TrackerState { kInitializing, kTracking, kLost };

// Why a frame has no pose.
enum class TrackingFailure {
  kNone,
  kTooFewFeatures,     // the image shows too little for a pose, or too little with depth (stereo,
                       // RGB-D) to start a map
  kNotRelocalized,     // nothing is known of the camera's place in the map yet
  kTooFewMatches,      // too few landmarks were found in the image
  kTooFewInliers,      // too few of the found landmarks agree on a pose
  kPoseNotObservable,  // the inliers do not fix the pose to tracking.max_pose_sigma
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

// Returns the state after a frame. After too many lost frames in a row a new map is to be started.
TrackerState NextState(TrackerState state, bool has_pose, int lost_frames, int new_map_after);

// A keyframe as the tracker made it. Its pose is relative to its parent in the snapshot that it was
// tracked against; mapping may have moved the parent when the keyframe comes into the map.
struct NewKeyFrame {
  KeyFrame keyframe;
  TrackingScores scores;
  RelativePose from_parent = {};  // used only where there is a parent
  // The pyramid of the rectified left image, where mapping is to align points in it (PointAligner);
  // else null.
  std::shared_ptr<const ImagePyramid> left_pyramid = nullptr;
};

// How a tracker uses a map that an earlier run made.
struct MapUse {
  KeyFrameId next_keyframe;  // the first id that no keyframe of the map has
  bool read_only = false;    // make no keyframes and start no map, however long the camera is lost
  int patience = 200;        // lost frames after which another map starts
};

// How long a lost camera is looked for before another map may start, beyond tracking.new_map_after.
struct LossPatience {
  // Least time since the last pose. It does not hold in a map that is on trial or was made by an
  // earlier run.
  double min_seconds = 0;
  // Frames that show too little for a pose (a covered lens, darkness) and do not count as lost.
  // Once there was one, no map starts before the old one was asked for a frame that shows more
  // (NotFound).
  int blind_frames = 0;
};

// What a live run tells the tracker in addition to the frame and the map.
struct LiveConditions {
  // The map around an earlier keyframe, which is tried by appearance where the map gives no pose.
  // May be null.
  const MapSnapshot* earlier = nullptr;
  // Share of the usual number of features that the frame was measured with.
  double feature_share = 1;
};

// What Tracker::Track made of a frame.
struct TrackingResult {
  TrackerState state = TrackerState::kInitializing;  // state after this frame
  TrackingFailure failure = TrackingFailure::kNone;
  FrameCounts counts;
  std::optional<Rigid3> cam_from_world;  // none where the frame has no pose
  // Covariance of the left perturbation [rotation, translation] of cam_from_world, by the inliers
  // and the motion so far, relative to a map that counts as exact (the depths of points from a
  // single frame do not, where tracking.point_covariance is on). None where the pose was not
  // estimated from matches: that of a first frame is chosen, that of a monocular start is adjusted
  // with its map.
  std::optional<Matrix6d> covariance;
  KeyFrameId reference;  // the keyframe that the pose refers to from now on
  RelativePose from_reference;
  std::optional<NewKeyFrame> keyframe;
  bool starts_map = false;  // the keyframe is the first of a new map
  // The snapshot is to be taken anew around the camera. Set only in a map that is not changed,
  // where the frame would otherwise become a keyframe.
  bool leaves_surroundings = false;
  Frame frame;  // the frame as tracked: features, and its matches where it has a pose
};

// Follows the camera: tracks one frame after the other against an immutable snapshot of the map.
//
// The pose is predicted by constant velocity. Landmarks of the last frame (and points and lines
// with depth that are not in the map yet) are searched near their predicted places, then the rest
// of the snapshot is searched; after each search the pose is estimated from points and lines
// together. When the prediction fails, the frame is matched by appearance with the snapshot's
// keyframe.
//
// With TrackingReference::kLastFrame the last frame takes the place of the map: only points and
// lines made from its depths are used, as in stereo odometry (PL-SLAM of Gomez-Ojeda et al., the
// second paper's setting). No landmarks are kept. The first frame is the only keyframe, to which
// all poses refer. This needs a camera that measures depth.
class Tracker {
 public:
  // world_from_first_cam  pose given to the first frame of each map
  Tracker(const CameraAndPyramid& imaging,
          const TrackingOptions& options,
          const PoseEstimator& estimator,
          const Rigid3& world_from_first_cam,
          const LossPatience& loss = {});

  // Tracks a frame. `snapshot` is null exactly while the tracker has no map. The snapshot of a map
  // that was withdrawn ends that map: the frame has no pose, and the next frames begin another map.
  TrackingResult Track(FrameId id,
                       std::int64_t stamp_ns,
                       std::shared_ptr<const FrameFeatures> indexed,
                       const MapSnapshot* snapshot,
                       const LiveConditions& live = {});

  // Returns whether the next frame must know where its lines are in the right image before it is
  // tracked, which features do not tell by themselves (ExtractFeatures). A frame that starts a map,
  // or stands for the map (TrackingReference::kLastFrame), makes landmarks of them. Where the last
  // pose is known less well than usual, the next one gets all that its lines tell.
  bool NeedsRightLines() const;
  // Returns whether landmarks are made of the lines of the last frame, whose result is given: the
  // frame became a keyframe, or its pose is known less well than usual, so that the next one has to
  // be found by its lines.
  bool WantsRightLines(const TrackingResult& result) const;
  // Puts features with right lines in place of those of the last frame, its result and the keyframe
  // that it became.
  void Complete(const std::shared_ptr<const FrameFeatures>& whole, TrackingResult& result);

  // Begins to follow a map that was made of several frames. The snapshot is centred on its newest
  // keyframe, which is made of the present frame.
  //   velocity  of the camera there, as a left tangent per second
  TrackingResult StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity);

  // Begins lost in a map of an earlier run, and looks for the camera's place in it for as long as
  // `use` allows.
  void BeginLost(const MapUse& use);
  // Goes on, after being lost, from a frame whose place was found in the map. `snapshot` is taken
  // around the keyframe from which the place was found.
  void FollowFrom(const Relocalized& found, const MapSnapshot& snapshot);
  // Tells that a lost frame was looked for in the maps and not found.
  void NotFound() { asked_ = true; }
  // A keyframe was removed from the map: poses that refer to it refer to its parent from now on.
  void ReparentPoses(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);

  TrackerState state() const { return state_; }
  // Returns the id that the next keyframe will get.
  KeyFrameId next_keyframe() const { return next_keyframe_; }
  // Whether there is a last pose, so that a snapshot is needed for the next frame.
  bool follows() const { return last_.has_value(); }

 private:
  // Whether the last frame takes the place of the map.
  bool IsOdometry() const { return options_.reference == TrackingReference::kLastFrame; }

  // The keyframe that the last pose refers to.
  struct Anchor {
    KeyFrameId keyframe;
    RelativePose relative;
  };
  struct Tracked : LastFrame {
    Anchor anchor;
    // Used while the frame itself is a keyframe that is not in the map yet.
    Anchor parent;
  };

  // A pose, or why there is none.
  struct PoseCandidate {
    // The counts in this attempt are those in `counts`.
    std::optional<PoseAttempt> attempt;
    TrackingFailure failure = TrackingFailure::kNone;
    FrameCounts counts;

    bool Succeeded() const { return failure == TrackingFailure::kNone; }
  };

  // Tracks a frame against a map: predicts the pose, estimates it, decides about a keyframe.
  TrackingResult TrackInMap(Frame frame, const MapSnapshot& map, const LiveConditions& live);
  PoseCandidate EstimatePose(const Frame& frame,
                             const PosePrior& predicted,
                             const MapSnapshot& snapshot) const;
  bool FindInEarlierMap(const MapSnapshot& earlier, Frame& frame, PoseCandidate& found) const;
  static KeyFramePose MoveToMap(const MapSnapshot& map,
                                const MapSnapshot& seen,
                                PoseEstimate& pose);
  std::optional<PoseAttempt> TrackWithMotionModel(const Frame& frame,
                                                  const PosePrior& predicted,
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
  // without_pose: the counts of matches to report where there is no attempt.
  PoseCandidate CheckPose(std::optional<PoseAttempt> attempt,
                          const FrameCounts& without_pose) const;
  bool NeedsKeyFrame(const Frame& frame,
                     const LandmarkMatches& association,
                     const MapSnapshot& snapshot,
                     double feature_share) const;

  // reference, place: the keyframe that the frame's pose is relative to, and where it is.
  TrackingResult FinishTracked(Frame frame,
                               PoseCandidate found,
                               KeyFrameId reference,
                               const KeyFramePose& place,
                               bool wants_keyframe);
  TrackingResult FinishLost(Frame frame, TrackingFailure failure, FrameCounts counts);
  bool IsBlind(const Features& features) const;
  int Patience(const Frame& frame, bool blind) const;
  void ForgetLoss();
  TrackingResult StartMap(Frame frame);
  NewKeyFrame MakeKeyFrame(const Frame& frame, KeyFrameId parent, const RelativePose& from_parent);
  void UpdateLastFrame(const MapSnapshot& snapshot);

  TrackingOptions options_;
  PoseSearch search_;
  bool monocular_;
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
