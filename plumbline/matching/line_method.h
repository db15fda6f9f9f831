// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/landmarks.h"
#include "plumbline/matching/line_from_views.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/pose_optimization.h"
#include "plumbline/optimization/problem.h"

#include <array>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Parametrization of a line in bundle adjustment.
enum class LineParametrization {
  kPlucker,  // orthonormal form of the Plücker coordinates, 4 parameters
  // Orthonormal form turned about the axes of the frame: U <- Exp(theta) U, as PPL-SLAM does.
  kPluckerLeft,
  // Two points, 6 parameters. Those along the line are free: no image determines them.
  kEndpoints,
};

constexpr auto EnumNames(std::type_identity<LineParametrization>) {
  return std::array{std::pair{LineParametrization::kPlucker, "plucker"},
                    std::pair{LineParametrization::kPluckerLeft, "plucker_left"},
                    std::pair{LineParametrization::kEndpoints, "endpoints"}};
}

// The two residuals of a line in an image, in pixels.
enum class LineResidualKind {
  // Distances of the measured ends from the projected infinite line (first paper, eq. 13).
  kObservedEnds,
  // Distances of the projected ends from the measured infinite line (second paper, eq. 1).
  kProjectedEnds,
};

constexpr auto EnumNames(std::type_identity<LineResidualKind>) {
  return std::array{std::pair{LineResidualKind::kObservedEnds, "observed_ends"},
                    std::pair{LineResidualKind::kProjectedEnds, "projected_ends"}};
}

// Views used to triangulate a line of several keyframes.
enum class LineReconstruction {
  kNView,
  kCheckedNView,  // with the tests of the first paper (CheckedLineFromViews)
  kTwoView,
};

constexpr auto EnumNames(std::type_identity<LineReconstruction>) {
  return std::array{std::pair{LineReconstruction::kNView, "n_view"},
                    std::pair{LineReconstruction::kCheckedNView, "n_view_checked"},
                    std::pair{LineReconstruction::kTwoView, "two_view"}};
}

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

// Functions for creating, adjusting and projecting lines, by SlamOptions::lines.method. Each member
// defaults to the product's function. Only the laboratory sets others (lab/line_rivals); the rest
// of the product knows no other kind of line. The functions have no state and are called in any
// thread.
struct LineMethod {
  // Values of the options of these names to which this method belongs (CheckOptions).
  LineParametrization parametrization = LineParametrization::kPlucker;
  LineResidualKind residual = LineResidualKind::kObservedEnds;
  LineReconstruction reconstruction = LineReconstruction::kNView;
  // True if the ends of a line are its parameters: adjustments get them (BaProblem::line_ends) and
  // move them, and nothing cuts them to what a view shows.
  bool keeps_ends = false;

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

}  // namespace plumbline
