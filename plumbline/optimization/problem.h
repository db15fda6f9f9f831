// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A pixel measurement of a point in the left camera, with its disparity if measured. Residual (px -
// projection) / sigma_px and, as a third row, (disparity - predicted) / its sigma: the disparity,
// not the right column, because its error is independent of the left column's.
struct PointMeasurement {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  std::optional<Disparity> disparity;
};

// A segment measured in the left or right camera. Residual: signed distances of its two end points
// from the projected infinite line (Lee and Hwang, ICCV 2019, eq. 13), weighted by the inverse of
// `covariance` (2 x 2, px^2). Two measurements of one line in the two cameras of a pair are two
// LineMeasurements.
struct LineMeasurement {
  Segment2 segment;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  int camera = 0;  // camera of the pair: 0 the left (or only) one, 1 the right one
};

// Bundle adjustment as plain data, independent of the map.
struct BaProblem {
  // Initial pose of a camera.
  struct Pose {
    Rigid3 cam_from_world;
    bool fixed = false;
    // True if it comes soon after the previous pose in time (FixInconsistentPoses); not used by
    // SolveLocalBa.
    bool follows = true;
  };
  // An observation of a point; indices into `poses` and `points`.
  struct PointObservation {
    int pose = 0;
    int point = 0;
    PointMeasurement measurement;
  };
  // An observation of a line; indices into `poses` and `lines`.
  struct LineObservation {
    int pose = 0;
    int line = 0;
    LineMeasurement measurement;
  };
  // A line that is parallel to an axis, with either sense; indices into `axes` and `lines`.
  // Residual: the two components of the line's unit direction across the axis, over sigma.
  struct ParallelLine {
    int axis = 0;
    int line = 0;
    double sigma = 1;  // rad, per component
  };

  RectifiedCamera camera;
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;  // in the world
  std::vector<OrthonormalLine> lines;   // in the world
  // The two ends of each line, in the world, for solvers whose lines are two points; else empty.
  std::vector<Segment3> line_ends;
  std::vector<PointObservation> point_observations;
  std::vector<LineObservation> line_observations;
  std::vector<Eigen::Vector3d> axes;  // constant unit vectors in the world
  std::vector<ParallelLine> parallel_lines;
};

// Prior of a pose: normally distributed about `cam_from_world`, with the information of the left
// perturbation [rotation, translation]. Zero information: no prior.
struct PosePrior {
  Rigid3 cam_from_world;
  Matrix6d information = Matrix6d::Zero();
};

// A camera pose to be estimated from fixed landmarks by SolvePose (pose_optimization.h).
struct PoseProblem {
  // A point of the map and its measurement in the frame.
  struct PointMatch {
    Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
    PointMeasurement measurement;
    // Covariance of the point in the world [map scale^2], in addition to that of the measurement;
    // zero if the position counts as exact.
    Eigen::Matrix3d point_covariance = Eigen::Matrix3d::Zero();
  };
  // A line of the map and its measurement in the frame.
  struct LineMatch {
    PluckerLine line_in_world;
    LineMeasurement measurement;
    int group = 0;  // measurements of one landmark share a group and are kept or rejected together
    // Ends, in the world, of the part of the line in use; eq. 13 does not need them.
    Segment3 ends = {};
  };

  RectifiedCamera camera;
  Rigid3 cam_from_world;  // initial pose
  PosePrior prior;
  std::vector<PointMatch> points;
  std::vector<LineMatch> lines;
};

// Throws BugError if an observation has an index of no pose, landmark or axis, or if a parallel
// line has no positive sigma.
void CheckIndices(const BaProblem& problem);

// Returns true if all numbers of a problem are finite.
bool IsFinite(const BaProblem& problem);

// Returns for each pose of a problem the earlier poses that share a point or a line with it: the
// nonzero blocks of the reduced camera system (BlockPattern). When stopped, the pattern is
// incomplete and useless.
//
//   cost  O(sum over the landmarks of their observations squared); memory in proportion to the
//         observations and the pairs
std::vector<std::vector<int>> SharingPoses(const BaProblem& problem, const StopCheck& stop = {});

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
  // A step that leaves a point behind a camera carries the point along with a pose; false: such a
  // step is refused.
  bool carry_points = false;
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

// Settings of SolvePose.
struct PoseOnlyOptions {
  // Rounds of solving, each followed by classifying all matches anew.
  int rounds = 4;
  // Number of first rounds with the Huber loss; the others use plain squares.
  int robust_rounds = 2;
  int max_iterations = 10;  // iterations in a round
  // a round ends if the expected decrease of the cost by a step is less than this
  double decrement_tolerance = 1e-4;
};

template <class Visitor>
void VisitFields(Visitor&& visit, PoseOnlyOptions& o) {
  visit("rounds", o.rounds, "rounds of solving and classifying the matches", Range{1, 20});
  visit("robust_rounds", o.robust_rounds, "first rounds with the Huber loss", Range{0, 20});
  visit("max_iterations", o.max_iterations, "iterations per round", Range{1, 1000});
  visit("decrement_tolerance",
        o.decrement_tolerance,
        "decrease of the cost a step must promise [sigma^2]",
        Range{0, 1});
}

// The result of SolvePose, in the order of the problem.
struct PoseOnlyResult {
  Rigid3 cam_from_world;
  // J^T W J of the inliers and the prior at the solution, for the left perturbation [rotation,
  // translation].
  Matrix6d information = Matrix6d::Zero();
  std::vector<bool> point_inliers;  // one per PoseProblem::points
  std::vector<bool> line_inliers;   // one per PoseProblem::lines; equal within a group
  int inlier_points = 0;
  int inlier_line_groups = 0;
  double cost = 0;     // half the sum of squared whitened residuals of inliers and prior
  int iterations = 0;  // sum over all rounds
  // True if the last round met a tolerance, and inliers and prior determine all six degrees of
  // freedom. If false, the pose is the best one found; it is finite if the input is.
  bool converged = false;
};

}  // namespace plumbline
