// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/frame.h"
#include "plumbline/optimization/prepared_line.h"

#include <cstddef>

#include <Eigen/Core>

namespace plumbline {

// Returns the information of line feature i of a frame about a line in the world: J^T Sigma^-1 J
// over the residuals of its left and right measurement, for the orthonormal tangent of `line`. The
// pose counts as exact.
Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PluckerLine& line);
// Returns the information for a line prepared for many features.
Eigen::Matrix4d LineInformation(const RectifiedCamera& camera,
                                const Frame& frame,
                                std::size_t i,
                                const PreparedLine& line);

// Returns the derivative with respect to the orthonormal tangent of the point of the line at
// parameter t (PluckerLine::PointAt), restricted to its motion across the line.
Eigen::Matrix<double, 3, 4> ShiftJacobian(const PluckerLine& line,
                                          const OrthonormalLine& orthonormal,
                                          double t);

// Returns the standard deviation, in the map's scale, of the line's position at parameter t
// (PluckerLine::PointAt) in the worst direction across the line. Infinite if the information leaves
// that direction undetermined.
double SigmaAt(const PluckerLine& line, const Eigen::Matrix4d& information, double t);

}  // namespace plumbline
