// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include "drive_shape.h"
#include <vector>

namespace plumbline {

// A map as a car with a stereo camera would make it, without images: keyframes a metre apart, each
// of them adds 90 points and 10 lines that about eight keyframes in a row show, and half of those
// that come by later.
struct LongDrive {
  Map map;  // its keyframes are some centimetres beside their true places, and so are landmarks
  CameraAndPyramid imaging;
  std::vector<Rigid3> truth;  // cam_from_world, by keyframe
};

// Deterministic. About 3 s and 0.5 GB for 1000 keyframes.
LongDrive MakeLongDrive(DriveShape shape, int keyframes);

}  // namespace plumbline
