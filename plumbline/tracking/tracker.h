// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/placement.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/keyframe_policy.h"
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

enum class TrackerState { kInitializing, kTracking, kLost };
constexpr auto EnumNames(std::type_identity<TrackerState>) {
  return std::array{std::pair{TrackerState::kInitializing, "initializing"},
                    std::pair{TrackerState::kTracking, "tracking"},
                    std::pair{TrackerState::kLost, "lost"}};
}

// Why a frame has no pose.
enum class TrackingFailure {
  kNone,
  kTooFewFeatures,     // to start a map
  kNotRelocalized,     // nothing is known of the camera's place in the map yet
  kTooFewMatches,      // landmarks found in the image
  kTooFewInliers,      // of them agree on a pose
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
  RelativePose from_parent = {};  // of use only where there is a parent
  // The rectified left image, where mapping is to align points in it (PointAligner); else null.
  std::shared_ptr<const GrayImage> image = nullptr;
};

// How a tracker uses a map that an earlier run made.
struct MapUse {
  KeyFrameId next_keyframe;  // the first id that no keyframe of the map has
  bool read_only = false;    // make no keyframes and start no map, however long the camera is lost
  int patience = 200;        // lost frames after which another map starts
};

// What a live run tells the tracker in addition to the frame and the map.
struct LiveConditions {
  // The map around an earlier keyframe, which is tried by appearance where the map gives no pose.
  // May be null.
  const MapSnapshot* earlier = nullptr;
  double feature_share = 1;  // of the usual number of features that the frame was measured with
};

struct TrackingResult {
  TrackerState state = TrackerState::kInitializing;  // after this frame
  TrackingFailure failure = TrackingFailure::kNone;
  FrameCounts counts;
  std::optional<Rigid3> cam_from_world;  // where the frame has a pose
  KeyFrameId reference;                  // the keyframe it moves with from now on
  RelativePose from_reference;
  std::optional<NewKeyFrame> keyframe;
  bool starts_map = false;  // the keyframe is the first of a new map
  // In a map that is only read, set where there would be a keyframe otherwise: the snapshot is to
  // be taken anew around the camera.
  bool leaves_surroundings = false;
  Frame frame;  // as tracked: features, and matches where it has a pose
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
  // min_lost_seconds: from the last pose until a new map may start, beside tracking.new_map_after
  // and but for a map that is on trial.
  Tracker(const ImagingModel& imaging,
          const TrackingOptions& options,
          const PoseEstimator& estimator,
          const Rigid3& world_from_first_cam,
          double min_lost_seconds = 0);

  // snapshot: null exactly while the tracker has no map. One of a map that was withdrawn ends the
  // map: the frame has no pose, and the next ones begin another.
  TrackingResult Track(FrameId id,
                       std::int64_t stamp_ns,
                       std::shared_ptr<const IndexedFeatures> indexed,
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
  void Complete(const std::shared_ptr<const IndexedFeatures>& whole, TrackingResult& result);

  // Begins to follow a map that was made of several frames: the snapshot is centred on its newest
  // keyframe, which is made of the frame of today.
  //   velocity  of the camera there, as a left tangent per second
  TrackingResult StartFrom(const MapSnapshot& snapshot, const Vector6d& velocity);

  // Begins lost in a map that there is already, and looks for it until `use` says otherwise.
  void BeginLost(const MapUse& use);
  // Goes on, lost as it is, from a frame whose place was found in the map; `snapshot` is taken
  // around the keyframe that showed the way.
  void Resume(const Relocalized& found, const MapSnapshot& snapshot);
  // A keyframe was removed from the map: poses that refer to it refer to its parent from now on.
  void Rehang(KeyFrameId gone, KeyFrameId parent, const RelativePose& gone_from_parent);

  TrackerState state() const { return state_; }
  // The id that the next keyframe will get.
  KeyFrameId next_keyframe() const { return next_keyframe_; }
  // Whether there is a last pose, so that a snapshot is needed for the next frame.
  bool follows() const { return last_.has_value(); }

  // All that it keeps from frame to frame (base/byte_format.h).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.state_, self.last_, self.motion_, self.scores_);
    visit(self.next_keyframe_, self.newest_keyframe_, self.frames_since_keyframe_);
    visit(self.lost_frames_, self.use_, self.trial_keyframes_);
  }

 private:
  // The last frame stands for the map.
  bool IsOdometry() const { return options_.reference == TrackingReference::kLastFrame; }

  // The keyframe that the last pose refers to.
  struct Anchor {
    KeyFrameId keyframe;
    RelativePose relative;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.keyframe, self.relative);
    }
  };
  struct Tracked : LastFrame {
    Anchor anchor;
    Anchor parent;  // of use while the frame itself is a keyframe that is not in the map yet

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.frame, self.association, self.anchor, self.parent);
    }
  };

  // A pose, or why there is none.
  struct Finding {
    std::optional<PoseAttempt> attempt;  // its counts of matches are those below
    TrackingFailure failure = TrackingFailure::kNone;
    FrameCounts counts;

    bool Succeeded() const { return failure == TrackingFailure::kNone; }
  };

  // Tracks one frame against the map: predicts, searches and estimates, judges the pose, decides
  // about a keyframe.
  TrackingResult Follow(Frame frame, const MapSnapshot& snapshot, const LiveConditions& live);
  Finding Find(const Frame& frame, const PosePrior& predicted, const MapSnapshot& snapshot) const;
  Finding FindByAppearance(const Frame& frame, const MapSnapshot& snapshot) const;
  std::optional<PoseAttempt> NearPrediction(const Frame& frame,
                                            const PosePrior& predicted,
                                            const MapSnapshot& snapshot) const;
  std::optional<PoseAttempt> ByAppearance(const Frame& frame,
                                          const MapSnapshot& snapshot,
                                          FrameCounts& counts) const;
  PoseAttempt Settle(const Frame& frame,
                     const PoseEstimate& first,
                     const PosePrior& prior,
                     const MapSnapshot& snapshot,
                     FrameAssociation found) const;
  bool IsWeak(const PoseAttempt& attempt) const;
  // without_pose: the counts of matches where there is no attempt.
  Finding Judge(std::optional<PoseAttempt> attempt, const FrameCounts& without_pose) const;
  bool WantsKeyFrame(const Frame& frame,
                     const FrameAssociation& association,
                     const MapSnapshot& snapshot,
                     double feature_share) const;

  TrackingResult Succeed(Frame frame,
                         Finding found,
                         const MapSnapshot& snapshot,
                         bool wants_keyframe);
  TrackingResult Fail(Frame frame, TrackingFailure failure, FrameCounts counts);
  TrackingResult StartMap(Frame frame);
  NewKeyFrame MakeKeyFrame(const Frame& frame, KeyFrameId parent, const RelativePose& from_parent);
  void MoveWithMap(const MapSnapshot& snapshot);

  TrackingOptions options_;
  PoseSearch search_;
  bool monocular_;
  Rigid3 first_cam_from_world_;
  double min_lost_seconds_;
  TrackerState state_ = TrackerState::kInitializing;
  std::optional<Tracked> last_;
  MotionModel motion_;
  TrackingScores scores_;
  KeyFrameId next_keyframe_{0};
  KeyFrameId newest_keyframe_;
  std::int64_t frames_since_keyframe_ = 0;
  int lost_frames_ = 0;
  std::optional<MapUse> use_;  // of a map of an earlier run
  int trial_keyframes_ = 0;    // keyframes still to come until the map is trusted
};

}  // namespace plumbline
