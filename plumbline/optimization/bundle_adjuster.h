// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/optimization/ba_landmarks.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace plumbline {

// Implements SolveLocalBa for any kind of line. Internal to bundle_adjustment.cc and the
// laboratory, which compares other kinds of lines.

inline std::vector<BaPose> MakePoses(const BaProblem& problem) {
  std::vector<BaPose> poses(problem.poses.size());
  int free_index = 0;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    poses[i].Set(problem.poses[i].cam_from_world);
    if (!problem.poses[i].fixed) poses[i].free_index = free_index++;
  }
  return poses;
}

inline std::vector<BaObservation<PointTerm>> PointObservations(const BaProblem& problem) {
  std::vector<BaObservation<PointTerm>> out;
  out.reserve(problem.point_observations.size());
  for (const auto& o : problem.point_observations) {
    out.push_back({o.pose, o.point, MakePointTerm(o.measurement)});
  }
  return out;
}

// Returns one observation of a line of this kind for each observation of a line in the problem.
template <class LineKind>
std::vector<BaObservation<typename LineKind::Term>> LineObservationsOf(const BaProblem& problem) {
  std::vector<BaObservation<typename LineKind::Term>> out;
  out.reserve(problem.line_observations.size());
  for (const auto& o : problem.line_observations) {
    out.push_back({o.pose, o.line, LineKind::MakeTerm(problem.camera, o.measurement)});
  }
  return out;
}

// Levenberg-Marquardt over the poses, points and lines of a problem. The lines are given by the
// states and observations of their kind. A line of the problem is one state, or several if its ends
// are states of their own.
template <class LineKind>
class BundleAdjuster {
 public:
  using Lines = std::vector<typename LineKind::State>;
  using LineObservations = std::vector<BaObservation<typename LineKind::Term>>;

  BundleAdjuster(const BaProblem& problem,
                 Lines lines,
                 LineObservations line_observations,
                 const LocalBaOptions& options,
                 const StopCheck& stop)
      : options_(options),
        stop_(stop),
        poses_(MakePoses(problem)),
        trial_poses_(poses_),
        points_(problem.camera, problem.points, PointObservations(problem), poses_),
        lines_(problem.camera,
               std::move(lines),
               std::move(line_observations),
               poses_,
               BaParallelLines(problem)),
        solver_(static_cast<int>(std::count_if(
            poses_.begin(), poses_.end(), [](const BaPose& p) { return p.free_index >= 0; }))) {}

  // Returns the whole result except its lines.
  BaResult Solve();
  const Lines& lines() const { return lines_.states(); }

 private:
  // Initial damping, relative to the diagonal: small, since maps are nearly right.
  static constexpr double kInitialLambda = 1e-4;
  static constexpr double kMinLambda = 1e-9;
  static constexpr double kMaxLambda = 1e10;
  // Below this damping a step is nearly a Gauss-Newton step, so that a small decrease means
  // convergence.
  static constexpr double kSmallLambda = 1;

  double Cost(const HuberThresholds& huber) {
    return points_.Cost(poses_, huber) + lines_.Cost(poses_, huber);
  }
  // Linearizes and solves; returns false if the damped equations are not positive definite, or when
  // stopped.
  bool ComputeStep(const HuberThresholds& huber, double lambda);
  // Returns the cost of the trial state and sets expected_.
  double Try(const HuberThresholds& huber);
  void Accept();
  // Lowers cost_, which must be the cost under the same loss.
  BaTermination Optimize(const HuberThresholds& huber, double function_tolerance);
  // Classifies all observations anew; returns true if that changed which of them are in use.
  bool Classify();

  const LocalBaOptions& options_;
  const StopCheck& stop_;
  std::vector<BaPose> poses_, trial_poses_;
  BaLandmarks<BaPoint> points_;
  BaLandmarks<LineKind> lines_;
  SchurSolver solver_;
  double expected_ = 0;  // decrease of the cost predicted by the linear model
  double cost_ = 0;
  int iterations_ = 0;
};

template <class LineKind>
bool BundleAdjuster<LineKind>::ComputeStep(const HuberThresholds& huber, double lambda) {
  solver_.Reset();
  points_.Eliminate(poses_, huber, lambda, solver_);
  if (IsToStop(stop_)) return false;
  solver_.LaterLandmarksMayTie();
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
  const bool carry = options_.carry_points;
  const double cost = points_.Try(poses_, trial_poses_, huber, carry, solver_) +
                      lines_.Try(poses_, trial_poses_, huber, carry, solver_);
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
  // Residuals carry rounding errors of about 1e-12 sigma, so that smaller costs are meaningless.
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

}  // namespace plumbline
