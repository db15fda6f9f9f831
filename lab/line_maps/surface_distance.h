// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "worlds/parallelogram.h"

#include <optional>
#include <span>

namespace plumbline {

// Distance of pieces of lines from the nearest surface, weighted by length.
struct SurfaceDistance {
  double median = 0;        // metres
  double share_beyond = 0;  // share of the length beyond the limit, in [0, 1]
};

// Returns the distances of pieces. These are cut into cells of 5 mm (longer ones if the pieces sum
// up to more than 1 km), and each cell has the distance of its midpoint: an error of at most half a
// cell in each distance.
//
//   pieces, surfaces  metres, in one world
//   fails             nullopt without surfaces and for pieces without length
//   cost              O(surfaces) box tests for every 25 cm, plus what is close to them
std::optional<SurfaceDistance> DistanceFromSurfaces(std::span<const Segment3> pieces,
                                                    std::span<const Parallelogram> surfaces,
                                                    double limit);

}  // namespace plumbline
