// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/dataset.h"

namespace plumbline {

Trajectory GroundTruth::OfCamera(const Calibration& calibration) const {
  if (frame == Frame::kCamera) return poses;
  PLUMBLINE_CHECK(calibration.body_from_left.has_value(),
                  "ground truth of a body without its place");
  Trajectory camera = poses;
  for (StampedPose& pose : camera) {
    pose.world_from_camera = pose.world_from_camera * *calibration.body_from_left;
  }
  return camera;
}

}  // namespace plumbline
