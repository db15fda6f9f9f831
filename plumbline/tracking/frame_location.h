// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/pose_estimation.h"
#include "plumbline/tracking/pose_search.h"

#include <optional>

namespace plumbline {

struct LocatedFrame {
  Rigid3 cam_from_world;
  FrameCounts counts;
};

// The pose of a frame in a map that is known already, for frames out of turn: landmarks of the
// snapshot searched around their places from the predicted pose (with tracking's first radius, then
// its wide one), pose, search again with the usual radius, pose. Both poses must be accepted as
// tracking accepts one without prediction (TrackingOptions::max_pose_sigma). nullopt where the
// frame is not found.
std::optional<LocatedFrame> LocateFrame(const ImagingModel& imaging,
                                        const PoseEstimator& estimator,
                                        const IndexedFeatures& image,
                                        const Rigid3& predicted,
                                        const MapSnapshot& snapshot,
                                        double max_pose_sigma);

}  // namespace plumbline
