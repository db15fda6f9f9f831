// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <string>

namespace plumbline {

// A frame that is no keyframe, as it goes into an export: the name of its image, and where the
// rectified left camera was.
struct PosedImage {
  std::int64_t stamp_ns = 0;
  std::string name;
  Rigid3 cam_from_world;
};

}  // namespace plumbline
