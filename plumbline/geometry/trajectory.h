// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace plumbline {

// The pose of a camera at one time.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Rigid3 world_from_camera;
};

// Poses of one camera, stamps strictly ascending.
using Trajectory = std::vector<StampedPose>;

// Returns the pose at a stamp: linear in position, slerp in orientation between the two neighbours.
// Returns nullopt outside the trajectory's time and if the neighbours are more than max_gap_ns
// apart; a stamp of the trajectory always has a pose. Throws InputError for an invalid rotation
// (UnitRotation). O(log n).
std::optional<Rigid3> InterpolateAt(const Trajectory& trajectory,
                                    std::int64_t stamp_ns,
                                    std::int64_t max_gap_ns);

// Returns the index of the pose nearest in time (ties: the earlier one); nullopt if it is further
// away than max_difference_ns. O(log n).
std::optional<std::size_t> NearestIndex(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_difference_ns);

// Returns the trajectory with time running backwards: a pose at t moves to mirror_ns - t. Applied
// twice, this gives the original trajectory.
Trajectory TimeReversed(Trajectory trajectory, std::int64_t mirror_ns);

// Returns the trajectory with its rotations checked and normalized by UnitRotation
// (UnitRotation), whose error names the pose: "WHAT: pose 3 (from 0): expected ...".
Trajectory WithUnitRotations(Trajectory trajectory, std::string_view what);

// Returns the sum of the distances between successive positions, in metres.
double PathLength(const Trajectory& trajectory);

}  // namespace plumbline
