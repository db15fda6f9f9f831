// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"
#include "plumbline/geometry/trajectory.h"

#include <cstdint>
#include <map>
#include <vector>

namespace plumbline {

// Covariances of poses by stamp: of [x, y, z, rotation about x, y, z] along the axes of the world
// (PoseCovarianceInWorld).
using PoseCovariances = std::map<std::int64_t, Matrix6d>;

// Poses of a run, world_from_camera, in a unit of its own.
struct PromisedPoses {
  Trajectory poses;
  PoseCovariances covariances;
  double metres_per_unit = 1;
};

// Returns the errors of the motions over about `duration_ns` (the pose nearest to that, if within
// 5 %) from each pose that has a covariance to another one that has. The covariance of a motion is
// that of both poses, taken as independent. Independent of the worlds of both trajectories.
//
//   truth       the same camera
//   max_gap_ns  largest gap between true poses (InterpolateAt)
std::vector<ConsistencySample> MotionSamples(ConsistencyKind kind,
                                             const PromisedPoses& estimate,
                                             const Trajectory& truth,
                                             std::int64_t max_gap_ns,
                                             std::int64_t duration_ns);

}  // namespace plumbline
