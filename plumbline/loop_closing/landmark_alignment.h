// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/alignment_problem.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

// A relative pose, and the matches that agree with it.
struct AlignmentResult {
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale]. Without free scale the
  // last row and column are zero. It is multiplied by the mean squared residual where that is above
  // 1.
  Matrix7d covariance = Matrix7d::Zero();
  std::vector<bool> points, lines, sightings;  // whether each match agrees
};

// Finds a relative pose from few good matches among bad ones, by LO-RANSAC (ransac.h) over samples
// of three points or lines in any mixture (AlignSample). Poses are judged by RefineAlignment's
// residuals. The same input and seed give the same result.
//
// Returns nullopt with less than three matches, and where no sample determines a pose. Sightings
// are not used. Cost: about 2 ms for 100 matches, a third of which are right.
std::optional<Similarity3> AlignByRansac(const AlignmentProblem& problem, std::uint64_t seed);

// Finds the relative pose near a given one with which all matches agree best, and which matches do.
//
// Residuals: points have their difference in the image of the candidate's camera, in column, row
// and inverse depth, where their errors are nearly normal; lines have the distances of two places
// of the query's line from the candidate's line, across it; sightings have their error in the pixel
// (and the disparity). All are whitened by the covariance of both sides, so that every measurement
// behind the landmarks counts once. Gauss-Newton with Huber's loss; matches further off than `gate`
// times the 95 % limit of chi2 take no part.
//
// Returns nullopt where the matches leave a direction open, or fewer than three agree. O(matches).
std::optional<AlignmentResult> RefineAlignment(const AlignmentProblem& problem,
                                               const Similarity3& near,
                                               double gate);

}  // namespace plumbline
