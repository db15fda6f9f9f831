// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/trimming.h"
#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Covariances (3 x 3, camera frame, map unit^2) of the points of a line at the two ends of an
// interval. Across the line they are J Lambda^-1 J^T, with Lambda the information of the line's
// orthonormal tangent, whose undetermined directions have a standard deviation of 0.5 rad. Along
// the line neither image nor residual has any information. The variance there is the sum of the
// variances across the line, which makes the matrix regular, as the information printed in the
// paper requires.
struct EndCovariances {
  Eigen::Matrix3d start, end;
};
EndCovariances CovariancesOfEnds(const Rigid3& cam_from_world,
                                 const LineModel& line,
                                 const LineInterval& interval);

// Returns the covariance (3 x 3, present camera frame, map unit^2) of a point whose column, row
// (both in units of the focal length) and inverse depth (1/map unit) have the standard deviation
// `sigma`, in the camera that made it (CovarianceFromInverseDepth), rotated into the present
// camera. Nullopt if the point is not in front of the camera that made it.
//   made_from, cam_from_world  poses of the two cameras
std::optional<Eigen::Matrix3d> CarriedInverseDepthCovariance(const RectifiedCamera& camera,
                                                             const Rigid3& made_from,
                                                             const Rigid3& cam_from_world,
                                                             const Eigen::Vector3d& in_world,
                                                             double sigma);

// Input of cutting for a line match in addition to the problem: its landmark, and the standard
// deviation of the measured segment alone (sigma_px of the feature), which is greater than 0.
struct CutCandidate {
  const LineModel* model = nullptr;
  double sigma_px = 1;
  // Pose of the camera whose depths made the line, if it was made from one frame.
  std::optional<Rigid3> made_from = std::nullopt;
};

// A pose problem whose lines are cut (second paper, section 4; cut_lines.h), ready for SolvePose.
// It has the points that cutting.choose selects: by the product all of them.
//
// The cut applies to the part of the landmark that the measured segment of the left image covers at
// the problem's pose (first paper, eq. 26-30). The end covariances come from the landmark's
// information: for a line made from one stereo or RGB-D frame that of its measured disparities, for
// a line of the map that of all its observations. With cutting.ends=inverse_depth all ends have the
// same uncertainty instead, in image and inverse depth of the camera that made the line (the last
// frame's in odometry; otherwise the present one), rotated into the present camera. The errors of
// the two ends count as independent, as in the paper. The points of the problem are the constant
// part of the objective (eq. 7), wrong matches included. The right image has no part in the choice.
//
// The pieces are used in both images: they become the ends of a match, and the ends of its measured
// segment move to the projections of the piece, not beyond them (LineMethod::measure_piece).
// Weights of the pieces are those of the cut points by lines.weighting: none 1 px, scalar the mean
// variance, covariance one each (2 x 2 for correlated information). Lines left whole keep their
// measurement: those shorter than 5 px, without a visible part, or whose best piece is the whole
// line, unless cutting.choose asks to trim them.
//
//   problem     initial pose, points, lines
//   candidates  one for each entry of problem.lines
//   cost        that of cutting.choose, and some microseconds a line
PoseProblem WithCutLines(const PoseProblem& problem,
                         const std::vector<CutCandidate>& candidates,
                         const LineSettings& lines,
                         const CuttingSettings& cutting);

// Classifies the points and the whole lines of a problem as inliers of a pose. The limit is chi2 at
// 95 % times gate_scale; for lines it applies to all measurements of a group together. Whole lines
// are tested, since a piece of a wrong line may fit although the line does not.
std::vector<bool> PointsThatFit(const PoseProblem& problem,
                                const Rigid3& cam_from_world,
                                double gate_scale);
std::vector<bool> LinesThatFit(const PoseProblem& problem,
                               const LineMethod& method,
                               const Rigid3& cam_from_world,
                               double gate_scale);

}  // namespace plumbline
