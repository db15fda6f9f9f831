// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline {

// Returns the standard deviation in the worst direction: the square root of the largest eigenvalue.
// Infinite where the covariance has numbers that are not finite.
double LargestSigma(const Eigen::Matrix3d& covariance);

}  // namespace plumbline
