// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/tracking/frame_counts.h"
#include "plumbline/tracking/landmark_matches.h"
#include "plumbline/tracking/options.h"
#include "plumbline/tracking/pose_estimation.h"

#include <optional>

namespace plumbline {

// The last frame with a pose, moved with the map to its current state, and the landmarks it showed.
struct LastFrame {
  Frame frame;
  LandmarkMatches association;
};

// Pose found for a frame, with its matches.
struct PoseAttempt {
  LandmarkMatches association;
  // Landmarks of the map that should be visible; empty if the map was not searched.
  LandmarkIds expected;
  FrameCounts counts;  // counts of the matches
  PoseEstimate pose;
  bool predicted = false;  // true if a prediction of the pose took part in it
};

// Fewest points and lines that determine a pose: the first number holds for a pose near the
// predicted one, the second for a pose without prediction.
inline constexpr int kFewestInliers = 4;
inline constexpr int kFewestUnpredictedInliers = 10;
// Factor on the search radius if the first search found too little.
inline constexpr double kWideFactor = 3;

// Returns the search around predicted positions. Its radius is the largest error of a prediction,
// times `factor`.
ProjectionSearchOptions FirstSearch(double factor = 1);

// Returns true if more matches agree with a pose than by chance. A pose fitted to three points
// agrees with these, right or wrong. Each of the other matches agrees with a wrong pose if it
// happens to lie within its gate, so that their number is binomial. The number of inliers must be
// three standard deviations above its mean.
bool MoreThanChance(int agreeing, int matches);

// Finds the matches and the pose of a frame: first by the landmarks of the last frame near their
// predicted positions, or by descriptors without a prediction, then by the rest of the local map.
// Stateless.
class PoseSearch {
 public:
  PoseSearch(const CameraAndPyramid& imaging,
             const TrackingOptions& options,
             const PoseEstimator& estimator);

  // Finds a pose from the landmarks of the last frame, and from points and lines made from its
  // depths, near their projections by `predicted`, within `factor` times the usual radius.
  // Landmarks of more uncertain depth are used if the others are few or do not determine the pose.
  // Returns nullopt if no pose is accepted with more matches than by chance.
  std::optional<PoseEstimate> FromPrediction(const Frame& frame,
                                             const PosePrior& predicted,
                                             const LastFrame& last,
                                             const MapSnapshot& snapshot,
                                             LandmarkMatches& association,
                                             double factor = 1) const;
  // Finds a pose by matching descriptors with the newest keyframe (in odometry with the last
  // frame). Starts from the pose with most inlier points, or if there is none from the last pose.
  // Returns nullopt if no pose is accepted.
  std::optional<PoseEstimate> FromAppearance(const Frame& frame,
                                             const LastFrame& last,
                                             const MapSnapshot& snapshot,
                                             LandmarkMatches& association,
                                             FrameCounts& counts) const;
  // Searches more of the last frame's landmarks, starting from the first estimate and its matches.
  PoseAttempt WithLastFrame(const Frame& frame,
                            const PoseEstimate& first,
                            const PosePrior& prior,
                            LandmarkMatches found) const;
  // Searches the rest of the snapshot in the given windows, starting from the first estimate and
  // its matches. `expected` of the result are the landmarks that should be visible from there.
  // Established landmarks are not outvoted.
  PoseAttempt WithLocalMap(const Frame& frame,
                           const PoseEstimate& first,
                           const PosePrior& prior,
                           const MapSnapshot& snapshot,
                           const LandmarkMatches& found,
                           const ProjectionSearchOptions& windows) const;

  bool Accepted(const PoseEstimate& pose) const {
    return pose.Accepted(kFewestInliers, options_.max_pose_sigma);
  }
  // Returns true if more matches agree with a pose than would by chance with a wrong one.
  // Disagreeing lines do not count: lines are easily confused with their neighbours, so that many
  // disagree with right poses as well.
  static bool Agreed(const PoseEstimate& pose, const FrameCounts& counts) {
    return MoreThanChance(pose.Inliers(), counts.matched_points + pose.inlier_lines);
  }

 private:
  // Landmarks made from the last frame's depths. kKnown: only those with a well known depth.
  // kUncertain: those with an uncertain depth as well. kGuessed: in addition lines without depth,
  // which get the depth of the scene.
  enum class Depths { kKnown, kUncertain, kGuessed };
  struct LastSearch {
    Depths depths = Depths::kKnown;
    double factor = 1;  // factor on the usual radius around the predicted positions
  };
  LandmarkMatches LastLandmarks(const LastFrame& last,
                                const MapSnapshot& snapshot,
                                const Frame& frame,
                                Depths depths) const;
  std::optional<PoseEstimate> SearchLast(const Frame& frame,
                                         const PosePrior& predicted,
                                         const LastFrame& last,
                                         const MapSnapshot& snapshot,
                                         const LastSearch& how,
                                         LandmarkMatches& association) const;
  // Returns the landmark of a feature of an earlier frame: `known`, a landmark of the map, or if
  // that is nullptr one made from the feature's depth.
  std::optional<PointCandidate> PointOf(const SnapshotPoint* known,
                                        const Frame& frame,
                                        std::size_t feature,
                                        double max_relative_sigma) const;
  std::optional<LineCandidate> LineOf(const SnapshotLine* known,
                                      const Frame& frame,
                                      std::size_t feature,
                                      double max_relative_sigma) const;
  LandmarkMatches MatchAppearance(const Frame& frame,
                                  const Frame& reference,
                                  const MapSnapshot& snapshot) const;
  // Estimates a pose that favours established landmarks over recent ones. Moving objects make new
  // landmarks all the time, and near the camera, where disparities are most accurate, these outvote
  // walls known for long. If the pose from all matches loses some of the established landmarks,
  // although these determine a pose without the others and are consistent, they alone determine the
  // pose, and the others count if they agree with it.
  PoseEstimate EstimateFavoringEstablished(const Frame& frame,
                                           const Rigid3& initial,
                                           const PosePrior& prior,
                                           const MapSnapshot& snapshot,
                                           LandmarkMatches& association) const;

  bool IsOdometry() const { return options_.reference == TrackingReference::kLastFrame; }

  CameraAndPyramid imaging_;
  TrackingOptions options_;
  PoseEstimator estimator_;
};

// Finds the pose of a frame, possibly out of order, in a known map. Landmarks of the snapshot are
// searched around their projections by the predicted pose (with tracking's first radius, then with
// its wide one) and a pose is estimated; with this pose they are searched again with the usual
// radius, and the pose is estimated again. Both poses must pass the test that tracking applies to a
// pose without prediction (TrackingOptions::max_pose_sigma). Returns nullopt if the frame is not
// found. Expected landmarks are not determined.
std::optional<PoseAttempt> LocateFrame(const CameraAndPyramid& imaging,
                                       const PoseEstimator& estimator,
                                       const FrameFeatures& image,
                                       const Rigid3& predicted,
                                       const MapSnapshot& snapshot,
                                       double max_pose_sigma);

}  // namespace plumbline
