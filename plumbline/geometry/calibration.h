// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>

namespace plumbline {

// What is known of the sensor: one camera, and a second one or a depth image where there is one.
struct Calibration {
  Camera left;
  std::optional<Camera> right;
  Rigid3 right_from_left;  // meaningful with `right`
  // The images are undistorted already and, in stereo, corresponding points lie in equal rows.
  bool rectified = false;
  std::optional<double> depth_factor;  // RGB-D: value of the depth image per metre
  std::optional<double> rate_hz;
  // body: the frame of the ground truth, where that is not the camera's.
  std::optional<Rigid3> body_from_left;
};

}  // namespace plumbline
