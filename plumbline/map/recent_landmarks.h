// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <vector>

namespace plumbline {

// Landmarks created recently, still on probation. Some may have left the map.
struct RecentLandmarks {
  std::vector<PointId> points;
  std::vector<LineId> lines;
};

}  // namespace plumbline
