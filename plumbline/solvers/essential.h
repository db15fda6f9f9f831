// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/ray_match.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Returns the essential matrices E, x_b . E x_a = 0, of five matches: up to ten, with Frobenius
// norm 1.
//
// Nistér, "An efficient solution to the five-point relative pose problem" (PAMI 2004): the null
// space of the five equations (eq. 9), the ten cubic constraints on its coefficients (eq. 6, 7),
// elimination to a 3 x 3 matrix of polynomials in z, and the roots of its determinant, of degree
// ten. Works for coplanar points, too. The result is empty if the five equations are dependent.
// Cost: about 10 us.
std::vector<Eigen::Matrix3d> EssentialFromFivePoints(std::span<const RayMatch, 5> matches);

// Returns the essential matrix nearest to eight or more matches: linear least squares on centred
// and scaled coordinates (Hartley 1997), then two equal singular values and a zero one. Returns
// nullopt if the matches have more than one solution, as coplanar points do (null space of
// dimension 3).
std::optional<Eigen::Matrix3d> EssentialFromEightPoints(std::span<const RayMatch> matches);

// Returns the fundamental matrix of eight or more matches by the same linear least squares: of rank
// 2 in the normalized coordinates, but without the two equal singular values that a calibrated
// camera has. Nullopt as above.
std::optional<Eigen::Matrix3d> FundamentalFromEightPoints(std::span<const RayMatch> matches);

// Returns the four poses with this essential matrix: two rotations, each with a translation of
// length 1 and its opposite. The right one has the points in front of both cameras (cheirality).
std::array<Rigid3, 4> PosesFromEssential(const Eigen::Matrix3d& essential);

}  // namespace plumbline
