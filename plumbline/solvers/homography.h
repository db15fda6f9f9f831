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
// the projective basis. Returns nullopt where three of the points are on one line.
std::optional<Eigen::Matrix3d> HomographyFromFourPoints(std::span<const RayMatch, 4> matches);

// Returns the homography of four or more matches by linear least squares (DLT), with every equation
// divided by its standard deviation at the homography `start` where one is given. Returns nullopt
// where it is not determined.
std::optional<Eigen::Matrix3d> HomographyFromPoints(std::span<const RayMatch> matches,
                                                    const Eigen::Matrix3d* start = nullptr);

// Returns the squared distance of x_b from H x_a over its variance, to which both points
// contribute: chi-square with two degrees of freedom. (The small turn between the two axes of the
// uncertainty of x_a, seen in b, is left out.) Infinite where H x_a is at infinity.
double SquaredTransferError(const Eigen::Matrix3d& homography, const RayMatch& match);

// A motion that maps one plane as a homography does: H ~ R + (translation / distance) normal^T.
struct PlanarMotion {
  Rigid3 b_from_a;  // translation over the distance of the plane from camera a
  // Normal of the plane in frame a, away from the camera.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

// Returns all motions with this homography: two, each with the opposite normal and translation,
// four in all (Ma, Soatto, Kosecka and Sastry, "An Invitation to 3-D Vision", section 5.3; the
// results of Faugeras and Malis are the same). In each pair the motion is right whose plane is in
// front of the points seen (normal . x_a > 0). The two motions that are left cannot be told apart
// by two views of the plane. There is one motion without translation for a mere rotation, and none
// for a singular matrix.
//
//   homography  of any scale and sign; both cameras must be on the same side of the plane
std::vector<PlanarMotion> MotionsFromHomography(const Eigen::Matrix3d& homography);

}  // namespace plumbline
