// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/measurements.h"
#include "plumbline/optimization/prepared_line.h"

#include <Eigen/Cholesky>

namespace plumbline {

// A line in the world and its uncertainty, prepared for many measurements.
struct UncertainLine {
  UncertainLine(const PluckerLine& line, const Eigen::Matrix4d& information);

  PreparedLine prepared;
  Eigen::LLT<Eigen::Matrix4d> information;  // regularized
};

// AddLandmarkUncertainty of measurements.h, the same numbers.
void AddLandmarkUncertainty(const RectifiedCamera& camera,
                            const Rigid3& cam_from_world,
                            const UncertainLine& line,
                            LineWeighting weighting,
                            LineMeasurement& measurement);

}  // namespace plumbline
