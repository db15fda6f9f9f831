// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cutting_problem.h"

#include <span>
#include <vector>

#include <Eigen/Core>

// Good line cutting: pose estimation uses only the most informative piece of each 3D line (Zhao and
// Vela, ECCV 2018, section 4). docs/methods/line-cutting.md has the derivation and the errors of
// the paper.
namespace plumbline {

// Returns cuts for all lines, in their order, that raise the information of the pose.
//
// Use:
//   1. At the predicted pose, transform matched lines into the camera's frame; drop those with
//      an end at z <= 1e-6 m or a projection shorter than a few pixels.
//   2. Give each end a covariance (CovarianceFromDisparity, CovarianceFromInverseDepth), each line
//      its measured image line and the noise of that line, and the problem the information of the
//      points: J^T W J at a pose from points alone, or zero.
//   3. Use the pieces: residuals are the distances of the two cut points CutSegment(...) from the
//      measured image line (eq. 1, projected_ends). For residuals that measure the distance of
//      observed ends from the projected line (observed_ends, Plücker lines), move the observed ends
//      to ImageRatio(...) of the measured segment, oriented as the 3D one.
//      Weigh them equally (lines.weighting none), or by CutWeight(...). The measurement's own
//      weights of whole lines do not apply to cut points.
//   4. Cut again only after large motions: the cuts depend weakly on the pose.
//
// Method: one line after the other, once (Algorithm 1), each by gradient ascent on log det of the
// pose information (eq. 7) with its analytic gradient, started from full length and from either
// end (section 5.1). sigma_px is a floor: without it a line whose depth error lies along the
// viewing ray would be infinitely informative. Undetermined directions of the pose have
// kPriorInformation. Fewer than three lines have no printed information; they stay whole.
//
// In the chosen information a cut is never worse than full length. Deterministic; the cuts depend
// on the order of the lines. Throws BugError if an end of a line has z <= 1e-6 m, or a sigma_px is
// not positive.
//   cost: 60 lines 0.1 ms with independent; correlated twice, printed 25 times that
std::vector<LineCut> CutLines(const CuttingProblem& problem,
                              CuttingInformation information = CuttingInformation::kIndependent);

// Cuts one line after the other, once, beginning with given cuts. Returns the increase of log det.
// BugError as CutLines.
double CutEachLine(const CuttingProblem& problem,
                   CuttingInformation information,
                   std::vector<LineCut>& cuts);

// Returns the weight of the two residuals of a cut line, the distances of its cut points from the
// measured image line, in their order. With the gradient g of a residual with respect to its cut
// point and the covariance Sigma(a) of that point, (1 - a)^2 Sigma_start + a^2 Sigma_end:
//   independent  diag(1 / v), v = g^T Sigma(a) g + sigma_px^2
//   correlated   the inverse of the 2 x 2 covariance of the residuals, whose points share the ends
//                and the image line; if both points coincide, each counts half
//   printed      diag(g^T Sigma(a)^-1 g), which no solver can use as a weight
Eigen::Matrix2d CutWeight(const RectifiedCamera& camera,
                          const CuttableLine& line,
                          const LineCut& cut,
                          CuttingInformation information);

// Linearized point for the pose: the derivatives of its whitened residuals (2, or 3 with a
// disparity) with respect to the left perturbation exp([rotation, translation]).
using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor, 3, 6>;

// Returns the sum of rows^T rows over the points in use (all points if `used` is empty).
Matrix6d SumPoints(std::span<const PointRows> points, const std::vector<bool>& used = {});

// The features that decide about the pose of a frame.
struct ChosenFeatures {
  std::vector<bool> points;    // true for each point in use
  std::vector<LineCut> lines;  // LineCut::used, and the cut of each line
  bool others = true;          // whether lines that could not be offered are in use, whole
  bool trim = false;           // whether lines left whole are trimmed to what is measured of them
};

// Returns all points, and lines cut as by CutLines with the points as the constant part.
ChosenFeatures ChooseAll(const CuttingProblem& problem,
                         std::span<const PointRows> points,
                         const CuttingOptions& options);

// The options of cutting and the function that carries them out, where cutting.method is not none.
struct CuttingSettings : CuttingOptions {
  // Chooses the features from the matched points and the lines that can be cut.
  decltype(&ChooseAll) choose = ChooseAll;
};

}  // namespace plumbline
