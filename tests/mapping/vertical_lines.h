// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/synthetic_world.h"
#include <cstddef>

namespace plumbline {

// All lines are 1 m long and vertical, so that they leave a shift along y open.
inline SyntheticWorld WorldOfVerticalLines(std::size_t points, std::size_t lines) {
  SyntheticWorld world = MakeSyntheticWorld(points, lines);
  for (auto& line : world.lines) {
    const Eigen::Vector3d middle = line.segment.Midpoint();
    line.segment = {middle - Eigen::Vector3d(0, 0.5, 0), middle + Eigen::Vector3d(0, 0.5, 0)};
  }
  return world;
}

}  // namespace plumbline
