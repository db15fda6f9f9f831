// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/optimization/pose_terms.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace plumbline {

// Implements SolvePose for any residual of lines. Internal to pose_optimization.cc and to the
// residual of projected ends (tracking/projected_matches.cc).

// Returns true if all six degrees of freedom are determined: the information, scaled to a unit
// diagonal, is regular.
inline bool IsRegular(const Matrix6d& information) {
  if (!(information.diagonal().minCoeff() > 0)) return false;
  const Vector6d scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  return EigenvaluesOf<6>(scaled)(0) > 1e-10;
}

// Levenberg-Marquardt over one pose. `Line` is a match of a line, made of the camera and a
// PoseProblem::LineMatch, with the functions of PoseLine (pose_optimization.cc): Linearize,
// PoseRows and Distances.
template <class Line>
class PoseSolver {
 public:
  PoseSolver(const PoseProblem& problem, const PoseOnlyOptions& options)
      : camera_(problem.camera), prior_(problem.prior), options_(options) {
    Pack(problem);
  }

  PoseOnlyResult Solve(const Rigid3& initial);

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Squared norm assigned to a match in use without a residual (behind the camera), so that a step
  // cannot gain by moving points there.
  static constexpr double kInvalidChi2 = 1e8;
  static constexpr double kMinLambda = 1e-8;
  static constexpr double kMaxLambda = 1e8;
  // A round ends if a step lowers the cost by less than this fraction: the rest would move the pose
  // by far less than its standard deviation.
  static constexpr double kCostTolerance = 1e-5;

  void Pack(const PoseProblem& problem);
  // Returns cost and normal equations of the matches in use, and sets chi2 of all matches.
  PoseSums Evaluate(const Rigid3& pose, const HuberThresholds& huber);
  void EvaluatePoints(const Rigid3& pose, const HuberThresholds& huber, PoseSums& eq);
  void EvaluateLines(const Rigid3& pose, const HuberThresholds& huber, PoseSums& eq);
  void AddPrior(const Rigid3& pose, PoseSums& eq) const;
  // Runs Levenberg-Marquardt from pose_; returns true if it met a tolerance.
  bool Optimize(const HuberThresholds& huber, int max_iterations);
  // Returns the chi2 of a point at pose_, whose rotation is R.
  double PointChi2Of(const PosePoint& point, const Eigen::Matrix3d& R) const;
  // Computes chi2 of all matches at pose_, unless it is known (after a rejected step it is not).
  void UpdateChi2();
  // Improves a far-off pose with a Huber threshold that follows the median residual.
  void OptimizeCoarse();
  // Decides by chi2 which matches are in use; returns true if any changed.
  bool Classify();
  double MedianNorm();
  static HuberThresholds Thresholds(double scale) {
    return {scale * kHuberThresholds.point,
            scale * kHuberThresholds.disparity,
            scale * kHuberThresholds.line};
  }

  const RectifiedCamera camera_;
  const PosePrior prior_;
  const PoseOnlyOptions& options_;
  std::vector<PosePoint> points_;
  std::vector<Line> lines_;
  std::vector<std::size_t> line_group_;  // dense index of the group of each line
  std::vector<double> point_chi2_, line_chi2_, group_chi2_, group_limit_, scratch_;
  std::vector<char> point_used_, group_used_;
  Rigid3 pose_;
  bool chi2_is_current_ = false;  // true if the chi2 are those at pose_
  int iterations_ = 0;
};

template <class Line>
void PoseSolver<Line>::Pack(const PoseProblem& problem) {
  points_.reserve(problem.points.size());
  for (const auto& match : problem.points) {
    const auto uncertain = MakeUncertainPointTerm(camera_,
                                                  problem.cam_from_world,
                                                  match.point_in_world,
                                                  match.point_covariance,
                                                  match.measurement);
    if (uncertain) {
      points_.push_back({match.point_in_world, uncertain->term, uncertain->whitening});
    } else {
      // A match whose covariance has no term at the initial pose must not count as exact later. NaN
      // ensures that it never has a residual.
      const bool exact = match.point_covariance.isZero(0);
      constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
      points_.push_back({exact ? match.point_in_world : Eigen::Vector3d::Constant(kNowhere),
                         MakePointTerm(match.measurement),
                         {}});
    }
  }
  std::vector<int> names;
  names.reserve(problem.lines.size());
  for (const auto& match : problem.lines) names.push_back(match.group);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::vector<int> measurements(names.size(), 0);
  lines_.reserve(problem.lines.size());
  line_group_.reserve(problem.lines.size());
  for (const auto& match : problem.lines) {
    const auto place = std::lower_bound(names.begin(), names.end(), match.group);
    const auto group = static_cast<std::size_t>(place - names.begin());
    ++measurements[group];
    lines_.emplace_back(camera_, match);
    line_group_.push_back(group);
  }
  point_chi2_.assign(points_.size(), 0);
  point_used_.assign(points_.size(), 1);
  line_chi2_.assign(lines_.size(), 0);
  group_chi2_.assign(names.size(), 0);
  group_used_.assign(names.size(), 1);
  group_limit_.reserve(names.size());
  for (const int n : measurements) {
    group_limit_.push_back(Chi2Limit95(2 * n));
  }
  scratch_.reserve(points_.size() + lines_.size());
}

template <class Line>
void PoseSolver<Line>::EvaluatePoints(const Rigid3& pose,
                                      const HuberThresholds& huber,
                                      PoseSums& eq) {
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  PointLinearization lin;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PosePoint& point = points_[i];
    const Eigen::Vector3d p = R * point.in_world + pose.translation;
    const double k = point.term.disparity_weight > 0 ? huber.disparity : huber.point;
    if (!LinearizePoint(camera_, point.term, p, lin)) {
      point_chi2_[i] = kInfinity;
      if (point_used_[i]) eq.cost += 0.5 * HuberLoss(kInvalidChi2, k);
      continue;
    }
    if (point.whitening) lin.r = *point.whitening * lin.r;
    const double chi2 = lin.r.squaredNorm();
    point_chi2_[i] = chi2;
    if (!point_used_[i]) continue;
    eq.cost += 0.5 * HuberLoss(chi2, k);
    const double weight = HuberWeight(chi2, k);
    if (point.whitening) {
      AddPoint(lin.r, *point.whitening * PointJacobian(lin), p, weight, eq);
    } else {
      AddPoint(lin, p, weight, eq);
    }
  }
}

template <class Line>
void PoseSolver<Line>::EvaluateLines(const Rigid3& pose,
                                     const HuberThresholds& huber,
                                     PoseSums& eq) {
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  typename Line::Linearization lin;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const bool used = group_used_[line_group_[i]] != 0;
    if (!lines_[i].Linearize(camera_, pose, R, lin)) {
      line_chi2_[i] = kInfinity;
      if (used) eq.cost += 0.5 * HuberLoss(kInvalidChi2, huber.line);
      continue;
    }
    line_chi2_[i] = lin.at.r.squaredNorm();
    if (!used) continue;
    const auto [a, b] = lines_[i].PoseRows(lin);
    AddLine(lin.at.r, huber.line, a, b, eq);
  }
}

// Adds the prior. The derivative of its deviation with respect to the left perturbation is taken as
// the identity, which holds up to the square of the deviation's angle.
template <class Line>
void PoseSolver<Line>::AddPrior(const Rigid3& pose, PoseSums& eq) const {
  const Vector6d deviation = LogSe3(pose * Inverse(prior_.cam_from_world));
  const Vector6d gradient = prior_.information * deviation;
  eq.cost += 0.5 * deviation.dot(gradient);
  eq.g += gradient;
  eq.H += prior_.information;
}

template <class Line>
PoseSums PoseSolver<Line>::Evaluate(const Rigid3& pose, const HuberThresholds& huber) {
  PoseSums eq;
  EvaluatePoints(pose, huber, eq);
  EvaluateLines(pose, huber, eq);
  AddPrior(pose, eq);
  return eq;
}

template <class Line>
double PoseSolver<Line>::PointChi2Of(const PosePoint& point, const Eigen::Matrix3d& R) const {
  const Eigen::Vector3d p = R * point.in_world + pose_.translation;
  if (!point.whitening) return PointChi2(camera_, point.term, p).value_or(kInfinity);
  PointLinearization lin;
  if (!LinearizePoint(camera_, point.term, p, lin)) return kInfinity;
  return (*point.whitening * lin.r).squaredNorm();
}

template <class Line>
void PoseSolver<Line>::UpdateChi2() {
  if (chi2_is_current_) return;
  chi2_is_current_ = true;
  const Eigen::Matrix3d R = pose_.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    point_chi2_[i] = PointChi2Of(points_[i], R);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Eigen::Vector2d r;
    const bool valid = lines_[i].Distances(camera_, R, pose_.translation, r);
    line_chi2_[i] = valid ? r.squaredNorm() : kInfinity;
  }
}

template <class Line>
bool PoseSolver<Line>::Optimize(const HuberThresholds& huber, int max_iterations) {
  PoseSums eq = Evaluate(pose_, huber);
  chi2_is_current_ = true;
  double lambda = 1e-5;
  for (int i = 0; i < max_iterations && lambda <= kMaxLambda; ++i) {
    ++iterations_;
    Matrix6d A = eq.H;
    A.diagonal() += lambda * eq.H.diagonal().cwiseMax(1e-12 * eq.H.diagonal().maxCoeff());
    const Vector6d step = -SolveSymmetric<6>(A, eq.g);
    if (!step.allFinite()) return false;
    // Decrease of the cost predicted by the linear model, in squared sigmas.
    const double expected = -0.5 * eq.g.dot(step);
    const bool is_small = expected <= options_.decrement_tolerance;
    const Rigid3 trial = RetractLeft(pose_, step);
    const PoseSums next = Evaluate(trial, huber);
    chi2_is_current_ = next.cost <= eq.cost;
    if (chi2_is_current_) {
      const double gain = eq.cost - next.cost;
      const double tolerance = kCostTolerance * eq.cost;
      pose_ = trial;
      eq = next;
      lambda = std::max(kMinLambda, 0.1 * lambda);
      if (is_small || gain <= tolerance) return true;
    } else {
      if (is_small) return true;
      lambda *= 10;
    }
  }
  return false;
}

template <class Line>
double PoseSolver<Line>::MedianNorm() {
  scratch_.clear();
  scratch_.insert(scratch_.end(), point_chi2_.begin(), point_chi2_.end());
  scratch_.insert(scratch_.end(), line_chi2_.begin(), line_chi2_.end());
  return std::sqrt(std::min(UpperMedian(std::span<double>(scratch_)), kInvalidChi2));
}

template <class Line>
void PoseSolver<Line>::OptimizeCoarse() {
  // The norm of a residual of two rows has the median 1.18 sigma; 30 % outliers move it to 1.6.
  constexpr double kMedianOfInliers = 1.2;
  constexpr double kCloseEnough = 2;
  constexpr int kPasses = 5;
  for (int pass = 0; pass < kPasses; ++pass) {
    UpdateChi2();
    const double scale = MedianNorm() / kMedianOfInliers;
    if (scale < kCloseEnough) return;
    Optimize(Thresholds(0.5 * scale), 3);
  }
}

template <class Line>
bool PoseSolver<Line>::Classify() {
  bool changed = false;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const int dof = points_[i].term.disparity_weight > 0 ? 3 : 2;
    const char used = point_chi2_[i] <= Chi2Limit95(dof) ? 1 : 0;
    changed |= used != point_used_[i];
    point_used_[i] = used;
  }
  std::fill(group_chi2_.begin(), group_chi2_.end(), 0.0);
  for (std::size_t i = 0; i < lines_.size(); ++i) group_chi2_[line_group_[i]] += line_chi2_[i];
  for (std::size_t i = 0; i < group_chi2_.size(); ++i) {
    const char used = group_chi2_[i] <= group_limit_[i] ? 1 : 0;
    changed |= used != group_used_[i];
    group_used_[i] = used;
  }
  return changed;
}

template <class Line>
PoseOnlyResult PoseSolver<Line>::Solve(const Rigid3& initial) {
  pose_ = initial;
  PoseOnlyResult result;
  OptimizeCoarse();
  bool converged = false;
  for (int round = 0; round < options_.rounds; ++round) {
    const bool robust = round < options_.robust_rounds;
    const bool same_loss = round > 0 && (robust || round > options_.robust_rounds);
    converged = Optimize(robust ? Thresholds(1) : HuberThresholds{}, options_.max_iterations);
    UpdateChi2();
    if (!Classify() && converged && same_loss && !robust) break;
  }
  const PoseSums eq = Evaluate(pose_, {});
  result.cam_from_world = pose_;
  result.information = eq.H.selfadjointView<Eigen::Lower>();
  result.point_inliers.assign(point_used_.begin(), point_used_.end());
  result.line_inliers.reserve(lines_.size());
  for (const std::size_t group : line_group_) {
    result.line_inliers.push_back(group_used_[group] != 0);
  }
  result.inlier_points =
      static_cast<int>(std::count(point_used_.begin(), point_used_.end(), char{1}));
  result.inlier_line_groups =
      static_cast<int>(std::count(group_used_.begin(), group_used_.end(), char{1}));
  result.cost = eq.cost;
  result.iterations = iterations_;
  result.converged = converged && IsRegular(result.information);
  return result;
}

}  // namespace plumbline
