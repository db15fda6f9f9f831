// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/dataset.h"

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

Expected<ColorImage, ImageFailure> Dataset::ReadColor(std::size_t i) const {
  const Expected<SensorFrame, ImageFailure> frame = Read(i);
  if (!frame) return frame.error();
  return ToColor(frame->left);
}

}  // namespace plumbline
