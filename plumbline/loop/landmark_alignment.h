// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/loop/alignment_problem.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumbline {

struct AlignmentResult {
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale]; without free scale the
  // last row and column are zero. Multiplied by the mean squared residual where that is above 1.
  Matrix7d covariance = Matrix7d::Zero();
  std::vector<bool> points, lines, sightings;  // that agree
  double variance_factor = 1;                  // mean squared whitened residual of what agrees
};

// A relative pose from few good matches among bad ones: LO-RANSAC (ransac.h) over samples of three
// points or lines in any mixture. The rotation turns the directions of the lines, and those between
// points and to lines, upon each other (Kabsch 1976); translation and scale are then linear. Judged
// by RefineAlignment's residuals. Same input and seed, same result.
//
// nullopt with less than three matches, and where no sample determines a pose. Sightings are not
// looked at. Cost: about 2 ms for 100 matches a third of which are right.
std::optional<Similarity3> AlignByRansac(const AlignmentProblem& problem, std::uint64_t seed);

// The relative pose near a given one that all matches agree with best, and which of them do.
//
// Residuals: points by their difference as the candidate's camera would see them, in column, row
// and inverse depth, where their errors are nearly normal; lines by how far two places of the
// query's line are off the candidate's, across it; sightings by their pixel (and disparity). All
// are whitened by the covariance of both sides, so that every measurement behind the landmarks
// counts once. Gauss-Newton with Huber's loss; what is further off than `gate` times the 95 % limit
// of chi2 does not take part.
//
// nullopt where the matches leave a direction open, or fewer than three agree. O(matches).
std::optional<AlignmentResult> RefineAlignment(const AlignmentProblem& problem,
                                               const Similarity3& near,
                                               double gate);

}  // namespace plumbline
