// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <string>

namespace plumbline {

// An exported frame that is no keyframe: the name of its image, and the pose of the rectified left
// camera.
struct PosedImage {
  std::int64_t stamp_ns = 0;
  std::string name;
  Rigid3 cam_from_world;
};

}  // namespace plumbline
