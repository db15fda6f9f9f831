// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/residuals.h"

#include <optional>

#include <Eigen/Core>

namespace plumbline {

// A line in the world with what the residuals of all its measurements need of it, computed once.
struct PreparedLine {
  explicit PreparedLine(const OrthonormalLine& line);

  Vector6d homogeneous;                       // moment, direction
  Eigen::Matrix<double, 6, 4> J_orthonormal;  // of these by the orthonormal update
};

// The same as of the orthonormal line.
std::optional<LineResidual> EvaluateLine(const RectifiedCamera& camera,
                                         const Rigid3& cam_from_world,
                                         const PreparedLine& line_in_world,
                                         const LineMeasurement& measurement);

// The residual alone: LineResidual::r.
std::optional<Eigen::Vector2d> LineDistances(const RectifiedCamera& camera,
                                             const Rigid3& cam_from_world,
                                             const PreparedLine& line_in_world,
                                             const LineMeasurement& measurement);

}  // namespace plumbline
