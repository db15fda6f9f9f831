// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"

namespace plumbline {

// A camera without a pair, with a wide image as on a car.
inline RectifiedCamera OneCamera() {
  RectifiedCamera camera;
  camera.fx = camera.fy = 350;
  camera.cx = 300;
  camera.cy = 90;
  camera.width = 600;
  camera.height = 180;
  return camera;
}

}  // namespace plumbline
