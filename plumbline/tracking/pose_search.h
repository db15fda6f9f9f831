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

// The last frame that had a pose, moved with the map as that is now, and the landmarks it showed.
struct LastFrame {
  Frame frame;
  LandmarkMatches association;
};

// A pose that was found for a frame, with the matches that it was found by.
struct PoseAttempt {
  LandmarkMatches association;
  // Landmarks of the map that should be visible; empty where the map was not searched.
  ExpectedLandmarks expected;
  FrameCounts counts;  // counts of the matches
  PoseEstimate pose;
};

// Fewest points and lines that fix a pose: the first number holds for a pose near the predicted
// one, the second for a pose without prediction.
inline constexpr int kFewestInliers = 4;
inline constexpr int kFewestUnpredictedInliers = 10;
// The search is larger by this factor where the first one found too little.
inline constexpr double kWideFactor = 3;

// Returns the search around predicted places. Its radius is how far a prediction may be off, times
// `factor`.
ProjectionSearchOptions FirstSearch(double factor = 1);

// Whether more matches agree with a pose than chance explains. A pose that is fitted to three
// points agrees with these whether it is right or wrong. Each of the other matches agrees with a
// wrong pose where it happens to lie within its gate, so that their number is binomial. The number
// that agrees has to be three standard deviations above its mean.
bool MoreThanChance(int agreeing, int matches);

// Finds what a frame shows and its pose from it: first the landmarks of the last frame near where a
// prediction puts them, or by descriptor where there is no prediction, then the rest of the local
// map. Nothing is kept from frame to frame.
class PoseSearch {
 public:
  PoseSearch(const CameraAndPyramid& imaging,
             const TrackingOptions& options,
             const PoseEstimator& estimator);

  // Finds a pose from the landmarks that the last frame showed, and from points and lines made from
  // its depths, near where `predicted` puts them. Landmarks of more uncertain depth are used where
  // the others do not fix the pose or are few. Returns nullopt where no pose is accepted with which
  // more matches agree than by chance.
  std::optional<PoseEstimate> FromPrediction(const Frame& frame,
                                             const PosePrior& predicted,
                                             const LastFrame& last,
                                             const MapSnapshot& snapshot,
                                             LandmarkMatches& association) const;
  // Finds a pose by comparing descriptors with the newest keyframe (in odometry with the last
  // frame). Starts from the pose with which most points agree, or where there is none from the last
  // pose. Returns nullopt where no pose is accepted.
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
  // Whether more matches agree with a pose than chance lets agree with a wrong one. Lines do not
  // count against it: they are easily taken for their neighbours, so that many disagree with right
  // poses as well.
  static bool Agreed(const PoseEstimate& pose, const FrameCounts& counts) {
    return MoreThanChance(pose.Inliers(), counts.matched_points + pose.inlier_lines);
  }

 private:
  // Which landmarks are made from the last frame's depths. kKnown: those with a well known depth.
  // kUncertain: those with an uncertain depth as well. kGuessed: in addition lines without depth,
  // which are put at the depth of the scene.
  enum class Depths { kKnown, kUncertain, kGuessed };
  struct LastSearch {
    Depths depths = Depths::kKnown;
    double factor = 1;  // factor on the usual radius around the predicted places
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
  // Returns the landmark that a feature of an earlier frame shows: `known`, a landmark of the map,
  // or where that is nullptr one made from the feature's depth.
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
  // Estimates a pose that young landmarks cannot take from the established ones. Things that move
  // make new landmarks all the time, and near the camera, where disparities say most, these outvote
  // walls that have been known for long. Where the pose from all matches loses some of the
  // established landmarks, although these fix a pose without the others and agree among themselves,
  // the established ones decide, and the others count as far as they agree with them.
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

}  // namespace plumbline
