// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/base/random.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/ray_match.h"

#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

enum class RelativePoseModel { kEssential, kHomography };

// A relative pose that explains the matches, with its support and uncertainty.
struct RelativePoseHypothesis {
  RelativePoseModel model = RelativePoseModel::kEssential;  // the model that gave it
  Rigid3 b_from_a;                                          // |translation| = 1
  // For each match: true if its Sampson distance is within chi2 95 % (1 degree of freedom).
  std::vector<bool> is_inlier;
  int inliers = 0;
  int in_front = 0;  // inliers that triangulate in front of both cameras
  double cost = 0;   // sum over matches of min(chi2, gate)
  // Covariance of (w, d): rotation <- Exp(w) rotation, translation <- translation +
  // BasisAcross(translation) d (pose_refinement.h). Infinite on the diagonal if the matches do not
  // determine the pose.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
};

enum class RelativePoseMethod { kFivePoint, kEightPoint };
constexpr auto EnumNames(std::type_identity<RelativePoseMethod>) {
  return std::array{std::pair{RelativePoseMethod::kFivePoint, "five_point"},
                    std::pair{RelativePoseMethod::kEightPoint, "eight_point"}};
}

struct RelativePoseOptions {
  // Minimal solver; eight points, as in the paper, fail on planes.
  RelativePoseMethod method = RelativePoseMethod::kFivePoint;
  int max_iterations = 500;  // largest number of samples
};

// Returns all relative poses that explain the matches, the best first.
//
// LO-RANSAC runs with the five-point solver and also with homographies, whose two decompositions
// are both kept (two views of a plane cannot tell them apart). With method eight_point it runs with
// the eight-point solver alone, as in the first paper. Each pose is refined on the Sampson distance
// (RefinePose). The number of points in front determines the sign of the translation, and the
// rotation of the two of an essential matrix. A hypothesis is kept if its inliers are at least 0.7
// times those of the best, and if it differs by more than 0.3 degrees in rotation or 3 degrees in
// direction from each better one.
//
//   guesses  initial poses (|translation| > 0), for instance from constant velocity
//   returns  sorted by cost; empty for fewer matches than a sample has, or if no sample gave a
//            pose. Without parallax, the direction of the translation is noise, as its covariance
//            shows.
//   cost     1 to 2 ms for 300 matches of which a fifth are wrong
std::vector<RelativePoseHypothesis> EstimateRelativePoses(std::span<const RayMatch> matches,
                                                          const RelativePoseOptions& options,
                                                          Rng& rng,
                                                          std::span<const Rigid3> guesses = {});

// Returns true if a match, triangulated, is in front of both cameras.
bool IsInFront(const Rigid3& b_from_a, const RayMatch& match);

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
