// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/local_ba.h"

#include "plumbline/optimization/ba_landmarks.h"
#include "plumbline/optimization/ba_projected_ends.h"
#include "plumbline/optimization/check_problem.h"
#include "plumbline/optimization/line_ends.h"
#include "plumbline/optimization/robust_loss.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {
namespace {

// Of Levenberg and Marquardt, relative to the diagonal: small, since maps are nearly right.
constexpr double kInitialLambda = 1e-4;
constexpr double kMinLambda = 1e-9;
constexpr double kMaxLambda = 1e10;
// Below this damping a step is nearly that of Gauss-Newton, so that a small gain means convergence.
constexpr double kSmallLambda = 1;

std::vector<BaPose> MakePoses(const BaProblem& problem) {
  std::vector<BaPose> poses(problem.poses.size());
  int free_index = 0;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    poses[i].Set(problem.poses[i].cam_from_world);
    if (!problem.poses[i].fixed) poses[i].free_index = free_index++;
  }
  return poses;
}

std::vector<BaObservation<PointTerm>> PointObservations(const BaProblem& problem) {
  std::vector<BaObservation<PointTerm>> out;
  out.reserve(problem.point_observations.size());
  for (const auto& o : problem.point_observations) {
    out.push_back({o.pose, o.point, MakePointTerm(o.measurement)});
  }
  return out;
}

template <class LineKind>
std::vector<BaObservation<typename LineKind::Term>> LineObservations(const BaProblem& problem) {
  std::vector<BaObservation<typename LineKind::Term>> out;
  out.reserve(problem.line_observations.size());
  for (const auto& o : problem.line_observations) {
    out.push_back({o.pose, o.line, LineKind::MakeTerm(problem.camera, o.measurement)});
  }
  return out;
}

// Two landmarks for each line: start and end.
template <>
std::vector<BaObservation<BaLineEnd::Term>> LineObservations<BaLineEnd>(const BaProblem& problem) {
  std::vector<BaObservation<BaLineEnd::Term>> out;
  out.reserve(2 * problem.line_observations.size());
  for (const auto& o : problem.line_observations) {
    const auto [start, end] = BaLineEnd::MakeTerms(problem.camera, o.measurement);
    out.push_back({o.pose, 2 * o.line, start});
    out.push_back({o.pose, 2 * o.line + 1, end});
  }
  return out;
}

// LineKind: BaLine, BaLineLeft, BaLineEnds, BaProjectedLine, BaProjectedEnds or BaLineEnd.
template <class LineKind>
class BundleAdjuster {
 public:
  using Lines = std::vector<typename LineKind::State>;

  BundleAdjuster(const BaProblem& problem,
                 Lines lines,
                 const LocalBaOptions& options,
                 const StopCheck& stop)
      : options_(options),
        stop_(stop),
        poses_(MakePoses(problem)),
        trial_poses_(poses_),
        points_(problem.camera, problem.points, PointObservations(problem), poses_),
        lines_(problem.camera,
               std::move(lines),
               LineObservations<LineKind>(problem),
               poses_,
               BaParallelLines(problem)),
        solver_(static_cast<int>(std::count_if(
            poses_.begin(), poses_.end(), [](const BaPose& p) { return p.free_index >= 0; }))) {}

  // All but the lines of the result.
  BaResult Solve();
  const Lines& lines() const { return lines_.states(); }

 private:
  double Cost(const HuberThresholds& huber) {
    return points_.Cost(poses_, huber) + lines_.Cost(poses_, huber);
  }
  // Linearizes and solves; false when the damped equations are not positive definite.
  bool ComputeStep(const HuberThresholds& huber, double lambda);
  // Cost of the trial state; sets expected_.
  double Try(const HuberThresholds& huber);
  void Accept();
  // From cost_, the cost under the same loss.
  BaTermination Optimize(const HuberThresholds& huber, double function_tolerance);
  // True when this changed what is in use.
  bool Classify();

  const LocalBaOptions& options_;
  const StopCheck& stop_;
  std::vector<BaPose> poses_, trial_poses_;
  BaLandmarks<BaPoint> points_;
  BaLandmarks<LineKind> lines_;
  SchurSolver solver_;
  double expected_ = 0;  // decrease of the cost by the linear model
  double cost_ = 0;
  int iterations_ = 0;
};

template <class LineKind>
bool BundleAdjuster<LineKind>::ComputeStep(const HuberThresholds& huber, double lambda) {
  solver_.Reset();
  points_.Eliminate(poses_, huber, lambda, solver_);
  lines_.Eliminate(poses_, huber, lambda, solver_);
  return solver_.Solve(lambda, stop_);
}

template <class LineKind>
double BundleAdjuster<LineKind>::Try(const HuberThresholds& huber) {
  expected_ = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const int index = poses_[i].free_index;
    if (index < 0) continue;
    const Vector6d step = solver_.step(index);
    expected_ -= 0.5 * solver_.pose(index).g.dot(step);
    trial_poses_[i].Set(RetractLeft(poses_[i].cam_from_world, step));
  }
  const double cost =
      points_.Try(trial_poses_, huber, solver_) + lines_.Try(trial_poses_, huber, solver_);
  expected_ += points_.expected_decrease() + lines_.expected_decrease();
  return cost;
}

template <class LineKind>
void BundleAdjuster<LineKind>::Accept() {
  std::swap(poses_, trial_poses_);
  points_.Accept();
  lines_.Accept();
}

template <class LineKind>
BaTermination BundleAdjuster<LineKind>::Optimize(const HuberThresholds& huber,
                                                 double function_tolerance) {
  double lambda = kInitialLambda;
  // Residuals carry rounding errors of about 1e-12 sigma: lower costs mean nothing.
  const double rounding = 1e-22 * static_cast<double>(points_.used() + lines_.used());
  for (int i = 0; i < options_.max_iterations; ++i) {
    if (IsToStop(stop_)) return BaTermination::kStopped;
    ++iterations_;
    double cost = std::numeric_limits<double>::infinity();
    if (ComputeStep(huber, lambda)) {
      cost = Try(huber);
    } else if (IsToStop(stop_)) {
      return BaTermination::kStopped;
    }
    const double tolerance = std::max(function_tolerance * cost_, rounding);
    const bool nearly_gauss_newton = lambda <= kSmallLambda;
    if (cost <= cost_) {
      const double gain = cost_ - cost;
      Accept();
      cost_ = cost;
      if (gain <= tolerance && nearly_gauss_newton) return BaTermination::kConverged;
      if (gain > 0.5 * expected_) lambda = std::max(kMinLambda, 0.1 * lambda);
      if (gain < 0.1 * expected_) lambda = std::min(kMaxLambda, 4 * lambda);
    } else {
      if (std::isfinite(cost) && expected_ <= tolerance && nearly_gauss_newton) {
        return BaTermination::kConverged;
      }
      lambda *= 10;
      if (lambda > kMaxLambda) return BaTermination::kNoProgress;
    }
  }
  return BaTermination::kMaxIterations;
}

template <class LineKind>
bool BundleAdjuster<LineKind>::Classify() {
  const bool points_changed = points_.Classify(poses_);
  return lines_.Classify(poses_) || points_changed;
}

template <class LineKind>
BaResult BundleAdjuster<LineKind>::Solve() {
  BaResult result;
  points_.UseAll(poses_);
  lines_.UseAll(poses_);
  const HuberThresholds huber = options_.robust ? kHuberThresholds : HuberThresholds{};
  const int last = options_.rounds - 1;
  for (int round = 0; round <= last && points_.used() + lines_.used() > 0; ++round) {
    const bool rejecting = options_.rejection_tolerance > 0 && round < last;
    cost_ = Cost(huber);
    if (round == 0) result.initial_cost = cost_;
    result.termination =
        Optimize(huber, rejecting ? options_.rejection_tolerance : options_.function_tolerance);
    result.final_cost = cost_;
    if (result.termination == BaTermination::kStopped) {
      Classify();
      break;
    }
    if (!Classify() && rejecting) round = last - 1;
  }
  for (const BaPose& pose : poses_) result.poses.push_back(pose.cam_from_world);
  result.points = points_.states();
  points_.Export(result.point_chi2, result.point_inliers);
  lines_.Export(result.line_chi2, result.line_inliers);
  result.iterations = iterations_;
  result.line_bytes = lines_.Bytes();
  return result;
}

BaResult Unchanged(const BaProblem& problem) {
  BaResult result = InitialState(problem);
  result.point_inliers.assign(problem.point_observations.size(), false);
  result.line_inliers.assign(problem.line_observations.size(), false);
  const double infinite = std::numeric_limits<double>::infinity();
  result.point_chi2.assign(problem.point_observations.size(), infinite);
  result.line_chi2.assign(problem.line_observations.size(), infinite);
  result.termination = BaTermination::kNotFinite;
  return result;
}

// Line: BaLine or BaLineLeft.
template <class Line>
BaResult SolveWithLines(const BaProblem& problem,
                        const LocalBaOptions& options,
                        const StopCheck& stop) {
  BundleAdjuster<Line> adjuster(problem, problem.lines, options, stop);
  BaResult result = adjuster.Solve();
  result.lines = adjuster.lines();
  return result;
}

// Lines with ends at fixed parameters along them.
template <class Line>
BaResult SolveWithProjectedLines(const BaProblem& problem,
                                 const LocalBaOptions& options,
                                 const StopCheck& stop) {
  const std::vector<Segment3> ends = TrimmedEnds(problem);
  std::vector<LineWithEnds> states;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const PluckerLine line = ToPlucker(problem.lines[i]);
    states.push_back(
        {problem.lines[i], {line.ParameterOf(ends[i].start), line.ParameterOf(ends[i].end)}});
  }
  BundleAdjuster<BaProjectedLine<Line>> adjuster(problem, std::move(states), options, stop);
  BaResult result = adjuster.Solve();
  for (const LineWithEnds& state : adjuster.lines()) result.lines.push_back(state.line);
  return result;
}

// Ends: BaLineEnds or BaProjectedEnds.
template <class Ends>
BaResult SolveWithEnds(const BaProblem& problem,
                       const LocalBaOptions& options,
                       const StopCheck& stop) {
  const std::vector<Segment3> ends = TrimmedEnds(problem);
  BundleAdjuster<Ends> adjuster(problem, ends, options, stop);
  BaResult result = adjuster.Solve();
  result.lines = LinesThroughEnds(problem.lines, ends, adjuster.lines());
  return result;
}

bool AllDiagonal(const BaProblem& problem) {
  const auto& observations = problem.line_observations;
  return std::all_of(observations.begin(), observations.end(), [](const auto& o) {
    return o.measurement.covariance(0, 1) == 0 && o.measurement.covariance(1, 0) == 0;
  });
}

// Starts and ends as landmarks of their own. An observation of a line counts when both count.
BaResult SolveWithSeparateEnds(const BaProblem& problem,
                               const LocalBaOptions& options,
                               const StopCheck& stop) {
  const std::vector<Segment3> ends = TrimmedEnds(problem);
  std::vector<BaLineEnd::State> states;
  for (const Segment3& s : ends) {
    states.push_back({s.start, s.end - s.start});
    states.push_back({s.end, s.end - s.start});
  }
  BundleAdjuster<BaLineEnd> adjuster(problem, std::move(states), options, stop);
  BaResult result = adjuster.Solve();
  std::vector<Segment3> moved;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    moved.push_back({adjuster.lines()[2 * i].point, adjuster.lines()[2 * i + 1].point});
  }
  result.lines = LinesThroughEnds(problem.lines, ends, moved);
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    result.line_chi2[k] = result.line_chi2[2 * k] + result.line_chi2[2 * k + 1];
    result.line_inliers[k] = result.line_inliers[2 * k] && result.line_inliers[2 * k + 1];
  }
  result.line_chi2.resize(problem.line_observations.size());
  result.line_inliers.resize(problem.line_observations.size());
  return result;
}

}  // namespace

BaResult InitialState(const BaProblem& problem) {
  BaResult state;
  for (const auto& pose : problem.poses) state.poses.push_back(pose.cam_from_world);
  state.points = problem.points;
  state.lines = problem.lines;
  state.point_inliers.assign(problem.point_observations.size(), true);
  state.line_inliers.assign(problem.line_observations.size(), true);
  return state;
}

BaResult SolveLocalBa(const BaProblem& problem,
                      const LocalBaOptions& options,
                      LineParametrization lines,
                      const StopCheck& stop) {
  CheckIndices(problem);
  if (!IsFinite(problem)) return Unchanged(problem);
  const bool projected = problem.line_residual == LineResidualKind::kProjectedEnds;
  switch (lines) {
    case LineParametrization::kPluckerLeft:
      return projected ? SolveWithProjectedLines<BaLineLeft>(problem, options, stop)
                       : SolveWithLines<BaLineLeft>(problem, options, stop);
    case LineParametrization::kEndpoints:
      if (!projected) return SolveWithEnds<BaLineEnds>(problem, options, stop);
      return AllDiagonal(problem) ? SolveWithSeparateEnds(problem, options, stop)
                                  : SolveWithEnds<BaProjectedEnds>(problem, options, stop);
    case LineParametrization::kPlucker:
      break;
  }
  return projected ? SolveWithProjectedLines<BaLine>(problem, options, stop)
                   : SolveWithLines<BaLine>(problem, options, stop);
}

}  // namespace plumbline
