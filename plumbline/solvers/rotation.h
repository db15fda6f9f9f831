// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/solvers/ray_match.h"

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A camera that turned and did not move.
struct RotationFit {
  Eigen::Quaterniond b_from_a = Eigen::Quaterniond::Identity();
  int inliers = 0;  // matches whose x_b is within chi2 95 % (2 degrees of freedom) of R x_a
  double cost = 0;  // sum over matches of min(chi2, gate)
  double median_residual = 0;  // angle between R x_a and x_b, radians
};

// The rotation that explains the matches best without a translation: RANSAC on two of them, then
// Gauss-Newton on the distance in image b under a robust loss. What it leaves over is parallax: as
// many inliers as a pose with translation has means that there is none to be seen.
RotationFit FitRotation(std::span<const RayMatch> matches, Rng& rng);

// Median angle between R x_a and x_b over the matches, radians: the parallax, where R is right.
// 0 without matches.
double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a);

}  // namespace plumbline
