// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/solvers/ray_match.h"

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

namespace plumbline {

// Returns the median angle [radians] between R x_a and x_b over the matches, with R = b_from_a: the
// parallax, if R is right. Returns 0 without matches.
double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a);

// Returns the largest angle that `count` of the matches have, or the smallest of all where there
// are fewer.
double ParallaxOf(std::size_t count,
                  std::span<const RayMatch> matches,
                  const Eigen::Quaterniond& b_from_a);

}  // namespace plumbline
