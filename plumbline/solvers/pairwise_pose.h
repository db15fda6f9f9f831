// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/ray_match.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Relative pose of two frames as in the first paper: the rotation by eight points, the translation
// by two.
struct PairwisePose {
  Rigid3 b_from_a;  // |translation| = 1
  std::vector<bool>
      is_inlier;  // for each match: true if it is near its epipolar lines (IsNearEpipolarLines)
};

// Estimates the pose of camera b from matches alone.
//
// 1. RANSAC with the eight-point algorithm gives an essential matrix, which is estimated again from
// all its inliers. Of its two rotations the one with more inliers in front of both cameras is kept.
// 2. With that rotation, RANSAC with two points gives the direction of the translation: t is normal
// to R x_a x x_b for every match. It is estimated again from all its inliers. The points in front
// determine its sign.
//
// No nonlinear refinement. The eight-point algorithm fails for coplanar points.
//
//   returns  nullopt for fewer than eight matches, and if no sample gives a pose
//   cost     about a millisecond for 300 matches
std::optional<PairwisePose> EstimatePairwisePose(std::span<const RayMatch> matches, Rng& rng);

// Returns the direction of the translation, up to its sign, from two matches with known rotation
// (first paper, section 2.1): the intersection of the planes of the two pairs of rays. Returns
// nullopt if the planes coincide or a match has no parallax.
std::optional<Eigen::Vector3d> TranslationFromTwoPoints(const Eigen::Quaterniond& b_from_a,
                                                        std::span<const RayMatch, 2> matches);

// Returns true if the symmetric epipolar distance of the first paper (section 2.2) is small: the
// squared distances of both points from their epipolar lines, over their variances, are each below
// 3.84, the 95 % limit of chi-square with one degree of freedom. (Their sum, the other meaning of
// "symmetric", has two degrees of freedom.)
bool IsNearEpipolarLines(const Eigen::Matrix3d& essential, const RayMatch& match);

}  // namespace plumbline
