// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/frame_location.h"

#include "plumbline/tracking/landmark_matches.h"

namespace plumbline {

std::optional<LocatedFrame> LocateFrame(const CameraAndPyramid& imaging,
                                        const PoseEstimator& estimator,
                                        const FrameFeatures& image,
                                        const Rigid3& predicted,
                                        const MapSnapshot& snapshot,
                                        double max_pose_sigma) {
  for (const double factor : {1.0, kWideFactor}) {
    LandmarkMatches association(image.features.points.size(), image.features.lines.size());
    LocatedFrame located;
    const auto accepted = [&](const Rigid3& initial) {
      located.counts.matched_points = association.matches.Points();
      located.counts.matched_lines = association.matches.Lines();
      const PoseEstimate pose = estimator.Estimate(image.features, initial, {}, association);
      located.cam_from_world = pose.cam_from_world;
      located.counts.inlier_points = pose.inlier_points;
      located.counts.inlier_lines = pose.inlier_lines;
      return pose.Accepted(kFewestUnpredictedInliers, max_pose_sigma);
    };
    MatchSnapshot(imaging, image, predicted, FirstSearch(factor), snapshot, association);
    if (!accepted(predicted)) continue;
    const Rigid3 first = located.cam_from_world;
    MatchSnapshot(imaging, image, first, {}, snapshot, association);
    if (accepted(first)) return located;
  }
  return std::nullopt;
}

}  // namespace plumbline
