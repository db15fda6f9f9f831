// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>

namespace plumbline {

// What is known of the sensor. `right` makes it a stereo pair, else `depth_factor` makes it an
// RGB-D camera, else it is a single camera. Each frame must then have that image; other images are
// left aside. To use less than there is, leave members out.
struct Calibration {
  Camera left;
  std::optional<Camera> right;
  // Between the cameras as delivered, before rectification; metres. Used with `right` alone.
  Rigid3 right_from_left;
  // The images are undistorted already and, in stereo, corresponding points lie in equal rows.
  bool rectified = false;
  // RGB-D: value of stored depth images per metre. SensorFrame::depth is in metres already.
  std::optional<double> depth_factor;
  // Nominal frames per second. Folders of images, which have no times, need it.
  std::optional<double> rate_hz;
  // body: the frame of the ground truth, where that is not the camera's.
  std::optional<Rigid3> body_from_left;
};

}  // namespace plumbline
