// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// Where a camera was at one time.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Rigid3 world_from_camera;
};

// Poses of one camera, stamps strictly ascending.
using Trajectory = std::vector<StampedPose>;

// Pose at a stamp: linear in position, slerp in orientation between the two neighbours. nullopt
// outside the trajectory's time and where the neighbours are more than max_gap_ns apart; a stamp
// that the trajectory contains is always answered. O(log n).
std::optional<Rigid3> InterpolateAt(const Trajectory& trajectory,
                                    std::int64_t stamp_ns,
                                    std::int64_t max_gap_ns);

// Index of the pose nearest in time (the earlier one of two equally near), nullopt when further
// away than max_difference_ns. O(log n).
std::optional<std::size_t> NearestIndex(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_difference_ns);

// The trajectory with time running backwards: a pose at t comes at mirror_ns - t. Done twice, it
// gives the trajectory itself.
Trajectory TimeReversed(Trajectory trajectory, std::int64_t mirror_ns);

// Sum of the distances between successive positions, metres.
double PathLength(const Trajectory& trajectory);

}  // namespace plumbline
