// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/frame_location.h"

#include "plumbline/tracking/frame_association.h"

namespace plumbline {
namespace {

FrameAssociation WithLandmarksOf(const MapSnapshot& snapshot, const Features& features) {
  FrameAssociation association(features.points.size(), features.lines.size());
  for (const SnapshotPoint& point : snapshot.points) {
    association.points.push_back({point.id, point});
  }
  for (const SnapshotLine& line : snapshot.lines) association.lines.push_back({line.id, line});
  return association;
}

}  // namespace

std::optional<LocatedFrame> LocateFrame(const ImagingModel& imaging,
                                        const PoseEstimator& estimator,
                                        const IndexedFeatures& image,
                                        const Rigid3& predicted,
                                        const MapSnapshot& snapshot,
                                        double max_pose_sigma) {
  for (const double factor : {1.0, kWideFactor}) {
    FrameAssociation association = WithLandmarksOf(snapshot, image.features);
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
    MatchCandidates(imaging, image, predicted, FirstSearch(factor), association);
    if (!accepted(predicted)) continue;
    const Rigid3 first = located.cam_from_world;
    MatchCandidates(imaging, image, first, {}, association);
    if (accepted(first)) return located;
  }
  return std::nullopt;
}

}  // namespace plumbline
