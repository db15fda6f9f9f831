// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/solvers/ray_match.h"

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// The direction of the translation, up to its sign, with the rotation known: it lies in the plane
// of the two rays of every match, t . (R x_a x x_b) = 0.

// The translation from two matches: where their planes meet. nullopt when the planes are the same,
// or a match has no parallax.
std::optional<Eigen::Vector3d> TranslationFromTwoPoints(const Eigen::Quaterniond& b_from_a,
                                                        std::span<const RayMatch, 2> matches);

// The translation from two or more matches: least squares on t . (R x_a x x_b) over its deviation
// at the direction `start`. nullopt with fewer, or where all planes are the same.
std::optional<Eigen::Vector3d> TranslationFromPoints(const Eigen::Quaterniond& b_from_a,
                                                     std::span<const RayMatch> matches,
                                                     const Eigen::Vector3d& start);

}  // namespace plumbline
