// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/optimization/prepared_line.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace plumbline {

// Returns the information with an added prior of standard deviation 0.5 rad for every direction of
// the tangent, which regularizes directions without information.
Eigen::Matrix4d RegularizedInformation(const Eigen::Matrix4d& information);

// A line in the world and its uncertainty, prepared for many measurements.
struct UncertainLine {
  UncertainLine(const PluckerLine& line, const Eigen::Matrix4d& information);

  PreparedLine prepared;
  Eigen::LLT<Eigen::Matrix4d> information;  // regularized
};

}  // namespace plumbline
