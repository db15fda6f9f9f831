// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cutting_problem.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// What a point tells about the pose: the derivatives of its whitened residuals (2, or 3 with a
// disparity) by the left perturbation exp([rotation, translation]).
using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor, 3, 6>;

struct ChosenFeatures {
  std::vector<bool> points;    // whether each point is used
  std::vector<LineCut> lines;  // LineCut::used, and how each line is cut
};

// Returns the `budget` features, points and lines together, from which the pose is best known. This
// is the joint problem that the second paper names for future work (section 7).
//
// How: features are added greedily by their gain of log det (eq. 7), starting from
// problem.other_information alone. The gain of a line is that of its best cut (with methods none
// and drop that of the whole line; drop leaves its lines out beforehand). No gain grows when other
// features are chosen first, since log det is submodular; that holds for the best over all cuts of
// a line, too. Only the feature with the best earlier gain is therefore looked at anew, until it
// stays the best (lazy greedy; Minoux 1978), which gives the choice of looking at all of them.
// Afterwards greedy_sweeps and joint cut the chosen lines again. The printed information does not
// add up feature by feature, so that the choice then uses the independent one.
//
// Everything is chosen where the budget is not less than the number of features, and cut as by
// CutLines. Deterministic: of equal gains points come first, then the order given.
//   cost: 40 of 200 points and 60 lines 0.7 ms, with greedy cuts 1.2 ms
ChosenFeatures ChooseFeatures(const CuttingProblem& problem,
                              std::span<const PointRows> points,
                              std::size_t budget,
                              const CuttingOptions& options);

// Cuts the used lines of a choice anew, as by CutLines, with its points as the constant part.
void CutChosen(const CuttingProblem& problem,
               std::span<const PointRows> points,
               const CuttingOptions& options,
               ChosenFeatures& choice);

// Returns the sum of rows^T rows over the points that are used (all points where `used` is empty).
Matrix6d SumPoints(std::span<const PointRows> points, const std::vector<bool>& used = {});

}  // namespace plumbline
