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

// The pose of one frame against another as the first paper finds it: the rotation by eight points,
// the translation by two.
struct PairwisePose {
  Rigid3 b_from_a;  // |translation| = 1
  std::vector<bool>
      is_inlier;  // for each match, whether it is near its epipolar lines (IsNearEpipolarLines)
};

// Estimates the pose of camera b from matches alone.
//
// 1. RANSAC with the eight-point algorithm gives an essential matrix; it is solved for again from
// all its inliers. Of
//    its two rotations the one stays by which more inliers are in front of both cameras.
// 2. With that rotation, RANSAC with two points gives the direction of the translation: t is normal
// to R x_a x x_b for
//    every match. It is solved for again from all its inliers. The points in front decide about its
//    sign.
//
// No nonlinear refinement. Eight points fail where all points lie in one plane.
//
//   returns  nullopt for fewer than eight matches, and where no sample gives a pose
//   cost     about a millisecond for 300 matches
std::optional<PairwisePose> EstimatePairwisePose(std::span<const RayMatch> matches, Rng& rng);

// Returns the direction of the translation from two matches with the rotation known (first paper,
// section 2.1): where the planes of the two pairs of rays meet, up to its sign. Nullopt where the
// planes are the same, or a match has no parallax.
std::optional<Eigen::Vector3d> TranslationFromTwoPoints(const Eigen::Quaterniond& b_from_a,
                                                        std::span<const RayMatch, 2> matches);

// The symmetric epipolar distance of the first paper (section 2.2): whether the squared distances
// of both places from their epipolar lines, over their variances, are below 3.84, the 95 % limit of
// chi-square with one degree of freedom. (Their sum, which the word "symmetric" may also mean, has
// two degrees of freedom.)
bool IsNearEpipolarLines(const Eigen::Matrix3d& essential, const RayMatch& match);

}  // namespace plumbline
