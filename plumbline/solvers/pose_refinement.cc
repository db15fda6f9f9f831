// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/pose_refinement.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/solvers/epipolar_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

// A pose with the numbers that all its residuals share.
struct SampsonModel {
  SampsonModel(const Rigid3& b_from_a, const Eigen::Matrix<double, 3, 2>& across_t)
      : R(b_from_a.rotation.toRotationMatrix()), t(b_from_a.translation), basis(across_t) {}

  SampsonResidual Evaluate(const RayMatch& match) const;

  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  Eigen::Matrix<double, 3, 2> basis;
};

SampsonResidual SampsonModel::Evaluate(const RayMatch& match) const {
  const Eigen::Vector3d b = match.b.homogeneous();
  const Eigen::Vector3d q = R * match.a.homogeneous();
  const Eigen::Vector3d in_b = t.cross(q);    // the epipolar line, E x_a
  const Eigen::Vector3d across = b.cross(t);  // R E^T x_b
  const Eigen::Vector2d in_a = R.leftCols<2>().transpose() * across;
  const double error = b.dot(in_b);
  const double variance_a = match.sigma_a * match.sigma_a;
  const double variance_b = match.sigma_b * match.sigma_b;
  const double variance =
      variance_b * in_b.head<2>().squaredNorm() + variance_a * in_a.squaredNorm();
  SampsonResidual r;
  if (!(variance > 0)) return r;
  const double inverse_sigma = 1 / std::sqrt(variance);
  r.value = error * inverse_sigma;

  // The error is b . (t x q). Its derivatives are those by w, with dq = w x q, and by t. Half the
  // derivative of the variance has the same form for the lines, weighted with themselves.
  const Eigen::Vector3d line_b(variance_b * in_b.x(), variance_b * in_b.y(), 0);
  const Eigen::Vector3d line_a = variance_a * (R.leftCols<2>() * in_a);
  const Eigen::Vector3d of_q = line_b.cross(t);  // d(line_b . (t x q)) / dq
  const Eigen::Vector3d error_by_w = q.cross(across);
  const Eigen::Vector3d error_by_t = q.cross(b);
  const Eigen::Vector3d variance_by_w = q.cross(of_q) + line_a.cross(across);
  const Eigen::Vector3d variance_by_t = q.cross(line_b) + line_a.cross(b);
  const double shrink = r.value * inverse_sigma;
  r.jacobian.head<3>() = inverse_sigma * (error_by_w - shrink * variance_by_w).transpose();
  r.jacobian.tail<2>() = inverse_sigma * (error_by_t - shrink * variance_by_t).transpose() * basis;
  return r;
}

struct NormalEquations {
  Matrix5d information = Matrix5d::Zero();
  Vector5d gradient = Vector5d::Zero();
  double cost = 0;
};

// Tukey's biweight of a squared residual: its loss, and its weight in the normal equations.
struct Biweight {
  double limit;  // square of the limit

  double Loss(double chi2) const {
    if (chi2 >= limit) return limit / 6;
    const double rest = 1 - chi2 / limit;
    return limit / 6 * (1 - rest * rest * rest);
  }
  double Weight(double chi2) const {
    if (chi2 >= limit) return 0;
    const double rest = 1 - chi2 / limit;
    return rest * rest;
  }
};

NormalEquations Linearize(std::span<const RayMatch> matches,
                          const Rigid3& pose,
                          const Biweight& loss) {
  NormalEquations equations;
  const SampsonModel model(pose, BasisAcross(pose.translation));
  for (const RayMatch& match : matches) {
    const SampsonResidual r = model.Evaluate(match);
    const double chi2 = r.value * r.value;
    equations.cost += loss.Loss(chi2);
    const double weight = loss.Weight(chi2);
    if (weight == 0) continue;
    const Vector5d weighted = weight * r.jacobian.transpose();
    equations.information += weighted * r.jacobian;
    equations.gradient += r.value * weighted;
  }
  return equations;
}

double CostOf(std::span<const RayMatch> matches, const Rigid3& pose, const Biweight& loss) {
  const Eigen::Matrix3d E = Skew(pose.translation) * pose.rotation.toRotationMatrix();
  double cost = 0;
  for (const RayMatch& match : matches) cost += loss.Loss(SampsonChi2(E, match));
  return cost;
}

// Returns the cost of a pose under the loss that RefinePose has by default.
double RefinementCost(std::span<const RayMatch> matches, const Rigid3& pose) {
  constexpr double kScale = PoseRefinementOptions{}.loss_scale;
  return CostOf(matches, pose, Biweight{kScale * kScale});
}

Rigid3 Moved(const Rigid3& pose, const Vector5d& step) {
  const Eigen::Vector3d t = pose.translation + BasisAcross(pose.translation) * step.tail<2>();
  return {(ExpSo3(step.head<3>()) * pose.rotation).normalized(), t.normalized()};
}

// Solves the damped normal equations.
Vector5d Step(const NormalEquations& equations, double damping) {
  Matrix5d damped = equations.information;
  damped.diagonal() *= 1 + damping;
  // A direction about which nothing is known does not move.
  damped.diagonal().array() += 1e-12 * damped.diagonal().maxCoeff() + 1e-300;
  const Vector5d step = -SolveSymmetric<5>(damped, equations.gradient);
  if (!step.allFinite()) return Vector5d::Zero();
  return step;
}

Matrix5d InverseOrInfinite(const Matrix5d& information) {
  if (const auto inverse = InverseOfInformation<5>(information, 1e-14)) return *inverse;
  Matrix5d unknown = Matrix5d::Zero();
  unknown.diagonal().setConstant(std::numeric_limits<double>::infinity());
  return unknown;
}

Matrix5d Covariance(std::span<const RayMatch> matches, const Rigid3& pose) {
  const SampsonModel model(pose, BasisAcross(pose.translation));
  Matrix5d information = Matrix5d::Zero();
  for (const RayMatch& match : matches) {
    const SampsonResidual r = model.Evaluate(match);
    if (r.value * r.value < kChi2OneDof95) information += r.jacobian.transpose() * r.jacobian;
  }
  return InverseOrInfinite(information);
}

}  // namespace

SampsonResidual EvaluateSampson(const Rigid3& b_from_a,
                                const Eigen::Matrix<double, 3, 2>& basis,
                                const RayMatch& match) {
  return SampsonModel(b_from_a, basis).Evaluate(match);
}

RefinedPose RefinePose(std::span<const RayMatch> matches,
                       const Rigid3& start,
                       const PoseRefinementOptions& options) {
  const Biweight loss{options.loss_scale * options.loss_scale};
  RefinedPose result;
  result.b_from_a = start;
  NormalEquations equations = Linearize(matches, start, loss);
  result.cost = equations.cost;
  double damping = 1e-4;
  for (; result.iterations < options.max_iterations && damping < 1e6; ++result.iterations) {
    const Vector5d step = Step(equations, damping);
    const Rigid3 trial = Moved(result.b_from_a, step);
    const double cost = CostOf(matches, trial, loss);
    if (!(cost <= result.cost)) {
      damping *= 10;
      continue;
    }
    const bool converged =
        result.cost - cost <= options.tolerance * result.cost || step.norm() < 1e-10;
    result.b_from_a = trial;
    result.cost = cost;
    damping = std::max(damping * 0.1, 1e-9);
    if (converged || result.iterations + 1 == options.max_iterations) break;
    equations = Linearize(matches, trial, loss);
  }
  if (options.covariance) result.covariance = Covariance(matches, result.b_from_a);
  return result;
}

RefinedPose PolishPose(std::span<const RayMatch> matches, const Rigid3& start, Rng& rng) {
  constexpr int kSubsets = 10;
  constexpr std::size_t kSubsetSize = 40;
  constexpr PoseRefinementOptions kRough{.max_iterations = 4, .loss_scale = 6, .covariance = false};
  // The subsets need only begin near the minimum.
  const Rigid3 first =
      RefinePose(matches, start, {.tolerance = 1e-3, .covariance = false}).b_from_a;
  std::vector<RayMatch> near;
  near.reserve(matches.size());
  const Eigen::Matrix3d E = EssentialMatrix(first);
  for (const RayMatch& match : matches) {
    if (SampsonChi2(E, match) < 2 * kChi2OneDof95) near.push_back(match);
  }
  if (near.size() < kSubsetSize) return RefinePose(matches, first);
  const EpipolarCost cost(matches);
  double lowest = cost.Truncated(E, kChi2OneDof95, std::numeric_limits<double>::infinity());
  Rigid3 pose = first;
  std::array<RayMatch, kSubsetSize> subset;
  for (int i = 0; i < kSubsets; ++i) {
    for (RayMatch& match : subset) match = near[rng.Index(near.size())];
    const Rigid3 trial = RefinePose(subset, pose, kRough).b_from_a;
    const double trial_cost = cost.Truncated(EssentialMatrix(trial), kChi2OneDof95, lowest);
    if (!(trial_cost < lowest)) continue;
    lowest = trial_cost;
    pose = trial;
  }
  const RefinedPose polished = RefinePose(matches, pose);
  if (polished.cost <= RefinementCost(matches, first)) return polished;
  return RefinePose(matches, first);
}

}  // namespace plumbline
