// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/ray_match.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Returns the homography x_b ~ H x_a of four matches, in closed form: both quadruples are images of
// the projective basis. Returns nullopt if three of the points are collinear.
std::optional<Eigen::Matrix3d> HomographyFromFourPoints(std::span<const RayMatch, 4> matches);

// Returns the homography of four or more matches by linear least squares (DLT): on centred and
// scaled coordinates (Hartley 1997) or, if a homography `start` is given, with every equation
// divided by its standard deviation there. Returns nullopt if it is not determined.
std::optional<Eigen::Matrix3d> HomographyFromPoints(std::span<const RayMatch> matches,
                                                    const Eigen::Matrix3d* start = nullptr);

// Returns the squared distance of x_b from H x_a over its variance, to which both points
// contribute: chi-square with two degrees of freedom. (The small rotation between the two axes of
// the uncertainty of x_a, seen in b, is neglected.) Infinite if H x_a is at infinity.
double SquaredTransferError(const Eigen::Matrix3d& homography, const RayMatch& match);

// A motion that induces a homography by a plane: H ~ R + (translation / distance) normal^T.
struct PlanarMotion {
  Rigid3 b_from_a;  // translation over the distance of the plane from camera a
  // Normal of the plane in frame a, away from the camera.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

// Returns all motions with this homography: two, each with the opposite normal and translation,
// four in all (Ma, Soatto, Kosecka and Sastry, "An Invitation to 3-D Vision", section 5.3; the
// results of Faugeras and Malis are the same). In each pair the right motion has its plane in front
// of the points seen (normal . x_a > 0). Two views of the plane cannot tell the two remaining
// motions apart. A pure rotation gives one motion without translation, a singular matrix none.
//
//   homography  of any scale and sign; both cameras must be on the same side of the plane
std::vector<PlanarMotion> MotionsFromHomography(const Eigen::Matrix3d& homography);

}  // namespace plumbline
