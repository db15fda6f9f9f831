// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/landmarks.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/pose_optimization.h"
#include "plumbline/optimization/problem.h"

#include <optional>

namespace plumbline {

// Tracking by lines.residual=projected_ends (second paper, eq. 1): members of a LineMethod.

// Returns the product's line method for these options: observed ends or, for poses, projected ends
// (LineMethod::only_odometry, since bundle adjustment has observed ends); lines from several
// keyframes with or without the tests of the first paper.
LineMethod ProductLineMethod(const LineOptions& options);

// A line and two points on it, in the world.
struct LineAndEnds {
  PluckerLine line;
  Segment3 ends;
};

// Converts a measurement for residuals that are the distances of the projected ends from the
// measured line: sets their covariance (ProjectedEndsCovariance) and, with information, adds that
// of the 3D line. For scalar weighting the mean of the two variances; for none nothing changes.
void UseProjectedEnds(const RectifiedCamera& camera,
                      const Rigid3& cam_from_world,
                      const LineAndEnds& line,
                      const std::optional<Eigen::Matrix4d>& information,
                      const LineWeights& weights,
                      LineMeasurement& measurement);

// Sets the ends of a match to the part of the line's interval visible to the camera from the
// initial pose, since an end behind the camera has no projection, or to the whole interval if no
// part is visible; and sets its covariance by UseProjectedEnds.
void WeighProjectedMatch(const PoseProblem& problem,
                         const LineModel& line,
                         const LineWeights& weights,
                         PoseProblem::LineMatch& match);
// SolvePose with the distances of the projected ends of each match.
PoseOnlyResult SolvePoseByProjectedEnds(const PoseProblem& problem, const PoseOnlyOptions& options);
// Squared norm of these distances, whitened; infinite if an end is not in front of the camera.
double ProjectedMatchChi2(const RectifiedCamera& camera,
                          const Rigid3& cam_from_world,
                          const PoseProblem::LineMatch& match);

}  // namespace plumbline
