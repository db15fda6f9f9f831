// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/alignment_problem.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// A relative pose, and its inlier matches.
struct AlignmentResult {
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale], multiplied by the mean
  // squared residual if that is above 1. Without free scale the last row and column are zero.
  Matrix7d covariance = Matrix7d::Zero();
  std::vector<bool> points, lines, sightings;  // true for inliers
};

// Estimates a relative pose from matches with many outliers, by LO-RANSAC (ransac.h) over samples
// of three points or lines in any mixture (AlignSample). Poses are scored by RefineAlignment's
// residuals. The same input and seed give the same result.
//
// Returns nullopt with less than three matches, and if no sample determines a pose. Sightings are
// not used. Cost: about 2 ms for 100 matches, a third of which are right.
std::optional<Similarity3> AlignByRansac(const AlignmentProblem& problem, std::uint64_t seed);

// Refines a relative pose near a given one with all matches, and classifies them.
//
// Residuals: points have their difference in the image of the candidate's camera, in column, row
// and inverse depth, where their errors are nearly normal; lines have the distances of two points
// of the query's line from the candidate's line, across it; sightings have their error in the pixel
// (and the disparity). All are whitened by the covariance of both sides, so that every measurement
// behind the landmarks counts once. Gauss-Newton with Huber's loss; matches further off than `gate`
// times the 95 % limit of chi2 are not used.
//
// Returns nullopt if the matches leave a direction undetermined, or fewer than three agree.
// O(matches).
std::optional<AlignmentResult> RefineAlignment(const AlignmentProblem& problem,
                                               const Similarity3& near,
                                               double gate);

}  // namespace plumbline
