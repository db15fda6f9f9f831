// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/pose_estimation.h"
#include "plumbline/tracking/pose_search.h"

#include <optional>

namespace plumbline {

// The pose of a frame in a map, and the matches behind it.
struct LocatedFrame {
  Rigid3 cam_from_world;
  FrameCounts counts;
};

// Finds the pose of a frame, possibly out of order, in a known map. Landmarks of the snapshot are
// searched around their projections by the predicted pose (with tracking's first radius, then with
// its wide one) and a pose is estimated; with this pose they are searched again with the usual
// radius, and the pose is estimated again. Both poses must pass the test that tracking applies to a
// pose without prediction (TrackingOptions::max_pose_sigma). Returns nullopt if the frame is not
// found.
std::optional<LocatedFrame> LocateFrame(const CameraAndPyramid& imaging,
                                        const PoseEstimator& estimator,
                                        const FrameFeatures& image,
                                        const Rigid3& predicted,
                                        const MapSnapshot& snapshot,
                                        double max_pose_sigma);

}  // namespace plumbline
