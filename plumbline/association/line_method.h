// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/line_from_views.h"
#include "plumbline/association/measurements.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/optimization/local_ba.h"
#include "plumbline/optimization/pose_only.h"
#include "plumbline/optimization/problem.h"

#include <array>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// The parameters of a line in bundle adjustment.
enum class LineParametrization {
  kPlucker,      // orthonormal form of the Plücker coordinates, 4 parameters
  kPluckerLeft,  // the same, turned about the axes of the frame: U <- Exp(theta) U, as PPL-SLAM
  kEndpoints,    // two points, 6 parameters; two of them are held, as no image fixes them
};

constexpr auto EnumNames(std::type_identity<LineParametrization>) {
  return std::array{std::pair{LineParametrization::kPlucker, "plucker"},
                    std::pair{LineParametrization::kPluckerLeft, "plucker_left"},
                    std::pair{LineParametrization::kEndpoints, "endpoints"}};
}

// The two residuals of a line in an image, in pixels.
enum class LineResidualKind {
  kObservedEnds,   // of the measured ends from the projected infinite line (first paper, eq. 13)
  kProjectedEnds,  // of the projected ends from the measured infinite line (second paper, eq. 1)
};

constexpr auto EnumNames(std::type_identity<LineResidualKind>) {
  return std::array{std::pair{LineResidualKind::kObservedEnds, "observed_ends"},
                    std::pair{LineResidualKind::kProjectedEnds, "projected_ends"}};
}

// What a line is made from where several keyframes show it.
enum class LineReconstruction { kNView, kTwoView };

constexpr auto EnumNames(std::type_identity<LineReconstruction>) {
  return std::array{std::pair{LineReconstruction::kNView, "n_view"},
                    std::pair{LineReconstruction::kTwoView, "two_view"}};
}

// Adds what the uncertainty of the line adds to the covariance of a match (AddLandmarkUncertainty).
void WeighLineMatch(const PoseProblem& problem,
                    const LineModel& line,
                    const LineWeights& weights,
                    PoseProblem::LineMatch& match);
// Squared norm of the whitened residual of a match (eq. 13) at a pose; infinite where there is
// none.
double LineMatchChi2(const RectifiedCamera& camera,
                     const Rigid3& cam_from_world,
                     const PoseProblem::LineMatch& match);
// Moves the ends of the measured segment to where they show a piece of the line, but not beyond it.
// `piece` in the frame of the camera that measured.
void MeasurePiece(const RectifiedCamera& camera,
                  const Segment3& piece,
                  PoseProblem::LineMatch& match);

// How lines are made, adjusted and held against images: what the product does, member by member.
// This is the one place where the laboratory puts functions of its own (lab/line_rivals); the rest
// of the product knows no other kind of line. Functions have no state and are called in any thread.
struct LineMethod {
  // The values of the options of this name that this is the method for (CheckOptions).
  LineParametrization parametrization = LineParametrization::kPlucker;
  LineResidualKind residual = LineResidualKind::kObservedEnds;
  LineReconstruction reconstruction = LineReconstruction::kNView;

  // A line of all the keyframes that seem to show it, two or more. Where there is none of more than
  // two, pairs are asked for.
  std::optional<MapLine> (*line_from_views)(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views) = LineFromViews;

  // Completes the window of a keyframe before its adjustment; null: it is complete. The lines are
  // free to move, and measurements have the covariance of their ends.
  void (*complete_window)(const LineWeights& weights, BaProblem& window) = nullptr;
  // The adjustment of a window, and of a whole map.
  BaSolver adjust_window = SolveLocalBa;
  BaSolver adjust_map = SolveLocalBa;

  // Completes a match of a line of the map before poses are estimated from it: the covariance,
  // which is that of the measured ends, and `ends` where they are of use. At
  // problem.cam_from_world.
  void (*weigh_match)(const PoseProblem& problem,
                      const LineModel& line,
                      const LineWeights& weights,
                      PoseProblem::LineMatch& match) = WeighLineMatch;
  // The pose of a frame from complete matches.
  PoseOnlyResult (*solve_pose)(const PoseProblem& problem,
                               const PoseOnlyOptions& options) = SolvePose;
  // Squared norm of the whitened residual of a complete match; infinite where there is none.
  double (*match_chi2)(const RectifiedCamera& camera,
                       const Rigid3& cam_from_world,
                       const PoseProblem::LineMatch& match) = LineMatchChi2;
  // Makes a match, whose `ends` are those of a piece of its line, one of this piece; null: it is.
  // `piece` in the frame of the camera that measured.
  void (*measure_piece)(const RectifiedCamera& camera,
                        const Segment3& piece,
                        PoseProblem::LineMatch& match) = MeasurePiece;
};

}  // namespace plumbline
