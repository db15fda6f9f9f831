// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/scene.h"

#include <array>

namespace plumbline {

// Cuts of a line along a camera path around it (second paper, Figure 2): from end on to broadside.
struct CameraPathPoint {
  double angle_deg = 0;  // between optical axis and line
  // Quartiles (25, 50 and 75 %) of the best ratios by brute force over the scenes.
  std::array<double, 3> first{}, second{};
};

// `scenes` random scenes at each of 19 angles from 0 to 90 degrees.
std::vector<CameraPathPoint> TryCameraPath(const SceneOptions& options, int scenes);

}  // namespace plumbline
