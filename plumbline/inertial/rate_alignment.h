// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trajectory.h"
#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_sample.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Place and clock of a gyroscope by what it and a camera measured of the same turns.
struct RateAlignment {
  Eigen::Quaterniond imu_from_camera = Eigen::Quaterniond::Identity();
  double rotation_sigma = 0;                                 // radians, in the worst direction
  double time_offset = 0;                                    // seconds, as in InertialCalibration
  double time_offset_sigma = 0;                              // seconds
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();  // rad/s
  double rate_sigma = 0;                                     // rad/s, what is left of an axis
  std::size_t intervals = 0;                                 // of the camera's poses
};

// Fits mean rate of the gyroscope = imu_from_camera * rate of the camera + bias over stretches of
// 40 to 150 ms between poses, for time offsets of -0.3 to 0.3 s: the rotation by Kabsch's method on
// centred rates, the offset by the least squared error on grids of 5 and 0.5 ms and a parabola.
// Deviations are those of the residual, that of the offset with rotation and bias free.
//
// Returns nullopt where the turns do not tell: fewer than 20 stretches, less than half of the
// gyroscope's energy explained (as at rest), an offset at the end of the range or known to no more
// than 1 ms, a rotation known to no more than 0.5 degrees (as where all turns have one axis). Cost:
// 150 evaluations of all stretches, some milliseconds for a minute.
std::optional<RateAlignment> AlignRates(const Trajectory& camera,
                                        std::span<const InertialSample> samples);

// Returns one sentence for each number of the calibration that the alignment contradicts by more
// than four deviations and more than 1 degree or 1 ms, with what would be right.
std::vector<std::string> AlignmentFaults(const RateAlignment& alignment,
                                         const InertialCalibration& calibration);

}  // namespace plumbline
