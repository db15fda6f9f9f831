// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/landmarks.h"
#include "plumbline/matching/line_from_views.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/pose_optimization.h"
#include "plumbline/optimization/problem.h"

#include <optional>
#include <vector>

namespace plumbline {

// Adds the uncertainty of a match's line to the covariance of the match (AddLandmarkUncertainty).
void WeighLineMatch(const PoseProblem& problem,
                    const LineModel& line,
                    const LineWeights& weights,
                    PoseProblem::LineMatch& match);
// Returns the squared norm of the whitened residual of a match (eq. 13) at a pose; infinite if the
// residual is not defined.
double LineMatchChi2(const RectifiedCamera& camera,
                     const Rigid3& cam_from_world,
                     const PoseProblem::LineMatch& match);
// Moves the ends of the measured segment to the projection of a piece of the line, but not beyond
// the segment. `piece` is in the frame of the measuring camera.
void MeasurePiece(const RectifiedCamera& camera,
                  const Segment3& piece,
                  PoseProblem::LineMatch& match);

// Functions for creating, adjusting and projecting lines. Each member defaults to the product's
// function for lines.residual=observed_ends and lines.reconstruction=n_view; others come by way of
// SystemMethods. The functions have no state and are called in any thread.
struct LineMethod {
  // True if the ends of a line are its parameters: adjustments get them (BaProblem::line_ends) and
  // move them, and nothing cuts them to what a view shows.
  bool keeps_ends = false;
  // True if poses have another residual than adjustments, which is for odometry against the last
  // frame alone (TrackingReference::kLastFrame; CheckOptions).
  bool only_odometry = false;

  // Makes a line from all keyframes that seem to show it, two or more. If more than two give no
  // line, it is called with pairs of them.
  std::optional<MapLine> (*line_from_views)(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views) = LineFromViews;

  // Completes the window of a keyframe before its adjustment; may be null. The lines are free to
  // move, and measurements have the covariance of their ends.
  void (*complete_window)(const LineWeights& weights, BaProblem& window) = nullptr;
  // Bundle adjustment of a window and of a whole map.
  BaSolver adjust_window = SolveLocalBa;
  BaSolver adjust_map = SolveLocalBa;

  // Completes a match with a line of the map before poses are estimated from it, at
  // problem.cam_from_world: sets the covariance, initially that of the measured ends, and `ends` if
  // needed.
  void (*weigh_match)(const PoseProblem& problem,
                      const LineModel& line,
                      const LineWeights& weights,
                      PoseProblem::LineMatch& match) = WeighLineMatch;
  // Estimates the pose of a frame from complete matches.
  PoseOnlyResult (*solve_pose)(const PoseProblem& problem,
                               const PoseOnlyOptions& options) = SolvePose;
  // Returns the squared norm of the whitened residual of a complete match; infinite if the residual
  // is not defined.
  double (*match_chi2)(const RectifiedCamera& camera,
                       const Rigid3& cam_from_world,
                       const PoseProblem::LineMatch& match) = LineMatchChi2;
  // Restricts a match whose `ends` are those of a piece of its line to that piece; may be null.
  // `piece` is in the frame of the measuring camera.
  void (*measure_piece)(const RectifiedCamera& camera,
                        const Segment3& piece,
                        PoseProblem::LineMatch& match) = MeasurePiece;
};

// The options of lines and the functions that carry them out.
struct LineSettings : LineOptions {
  LineMethod method = {};
};

}  // namespace plumbline
