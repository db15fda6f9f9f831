// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include "drive_shape.h"
#include <vector>

namespace plumbline {

// A map as of a car with a stereo camera, without images: keyframes a metre apart, each of which
// adds 90 points and 10 lines observed by about eight successive keyframes, and by half of the
// later ones at the same place.
struct LongDrive {
  Map map;  // keyframes and landmarks have errors of some centimetres
  CameraAndPyramid imaging;
  std::vector<Rigid3> truth;  // cam_from_world, by keyframe
};

// Deterministic. About 3 s and 0.5 GB for 1000 keyframes.
LongDrive MakeLongDrive(DriveShape shape, int keyframes);

}  // namespace plumbline
