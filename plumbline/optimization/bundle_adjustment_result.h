// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/optimization/problem.h"

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Settings of SolveLocalBa.
struct LocalBaOptions {
  int rounds = 2;           // rounds of solving, each followed by rejecting observations by chi2
  int max_iterations = 10;  // accepted and rejected steps in a round
  // a round ends if a step lowers the cost by less than this fraction
  double function_tolerance = 1e-4;
  // function_tolerance of the rounds before the last, whose purpose is to find outliers. If one of
  // these rounds changes no observation, the last round is next. 0: all rounds use
  // function_tolerance, and none is skipped.
  double rejection_tolerance = 0;
  bool robust = true;  // Huber loss (kHuberThresholds); false: plain squares
};

template <class Visitor>
void VisitFields(Visitor&& visit, LocalBaOptions& o) {
  visit("rounds", o.rounds, "rounds of solving and rejecting observations", Range{1, 20});
  visit("max_iterations", o.max_iterations, "iterations per round", Range{1, 1000});
  visit("function_tolerance",
        o.function_tolerance,
        "relative decrease of the cost that ends a round",
        Range{0, 1});
  visit("rejection_tolerance",
        o.rejection_tolerance,
        "the same of the rounds before the last, of which those that would change no outlier are "
        "left out; 0: as function_tolerance, and none is left out",
        Range{0, 1});
  visit("robust", o.robust, "use the Huber loss");
}

// Why the last round ended.
enum class BaTermination {
  kConverged,      // the cost no longer falls
  kMaxIterations,  // the budget of the last round is used up
  kNoProgress,     // no step lowers the cost, whatever the damping
  kNotFinite,      // the input has NaN or infinite numbers; the result repeats the input
  kNothingToDo,    // no observation has a residual at the start
  kStopped,        // stopped by `stop`; the state is that of the last accepted step
};

constexpr auto EnumNames(std::type_identity<BaTermination>) {
  return std::array{std::pair{BaTermination::kConverged, "converged"},
                    std::pair{BaTermination::kMaxIterations, "max_iterations"},
                    std::pair{BaTermination::kNoProgress, "no_progress"},
                    std::pair{BaTermination::kNotFinite, "not_finite"},
                    std::pair{BaTermination::kNothingToDo, "nothing_to_do"},
                    std::pair{BaTermination::kStopped, "stopped"}};
}

// The result of SolveLocalBa, in the order of the problem.
struct BaResult {
  std::vector<Rigid3> poses;  // cam_from_world; fixed poses are copied bit by bit
  std::vector<Eigen::Vector3d> points;
  std::vector<OrthonormalLine> lines;
  std::vector<Segment3> line_ends;  // moved, on the lines; empty if the problem has none
  // One entry per observation: false if chi2 exceeds its limit at the end, or if the point lies
  // behind the camera (chi2 is then infinite).
  std::vector<bool> point_inliers;
  std::vector<bool> line_inliers;
  std::vector<double> point_chi2;
  std::vector<double> line_chi2;
  // Half the sum of the loss over the observations in use: initially at the start of the first
  // round, with all observations that have a residual in use; finally at the end of the last round.
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
  std::size_t line_bytes = 0;  // memory of the lines and their observations, in bytes
  BaTermination termination = BaTermination::kNothingToDo;
};

// Returns the unsolved problem as a result, with all observations as inliers and chi2 unknown.
BaResult InitialState(const BaProblem& problem);

// Copies the solved poses and points into a problem; its lines are unchanged.
void TakePosesAndPoints(const BaResult& solved, BaProblem& problem);

// Returns the result for a problem with numbers that are not finite, which is not solved: the
// input, without inliers and with infinite chi2.
BaResult NotFinite(const BaProblem& problem);

}  // namespace plumbline
