// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>

namespace plumbline {

// Model of the sensor. `right` makes it a stereo pair, else `depth_factor` makes it an RGB-D
// camera, else it is a single camera. Each frame must have the images of its kind; other images are
// ignored. To use less than the sensor offers, leave members out.
struct Calibration {
  Camera left;
  std::optional<Camera> right;
  // From the left to the right camera as delivered, before rectification; metres. Only with
  // `right`.
  Rigid3 right_from_left;
  // True if the images are undistorted and, in stereo, corresponding points lie in equal rows.
  bool rectified = false;
  // RGB-D: value of stored depth images per metre. SensorFrame::depth is already in metres.
  std::optional<double> depth_factor;
  // Nominal frames per second. Required for folders of images, which have no times.
  std::optional<double> rate_hz;
  // body: the frame of the ground truth, if it is not the camera's.
  std::optional<Rigid3> body_from_left;
};

}  // namespace plumbline
