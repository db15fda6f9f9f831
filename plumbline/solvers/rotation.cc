// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/rotation.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/median.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/ransac.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {
namespace {

// Enough for two right ones of which a quarter is right.
constexpr int kMaxSamples = 110;

struct TransferResidual {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();  // over its standard deviation
  Eigen::Matrix<double, 2, 3> jacobian = Eigen::Matrix<double, 2, 3>::Zero();  // by w, Exp(w) R
};

// x_b - R x_a; false where R x_a is behind the camera. The deviation of x_a is taken over
// unchanged.
bool Evaluate(const Eigen::Matrix3d& R, const RayMatch& match, TransferResidual& r) {
  const Eigen::Vector3d q = R * match.a.homogeneous();
  if (!(q.z() > 0)) return false;
  const double inverse_sigma = 1 / math::Hypot(match.sigma_a, match.sigma_b);
  const Eigen::Vector2d place = q.head<2>() / q.z();
  r.value = inverse_sigma * (match.b - place);
  Eigen::Matrix<double, 2, 3> of_q;
  of_q << 1, 0, -place.x(), 0, 1, -place.y();
  r.jacobian = inverse_sigma / q.z() * of_q * Skew(q);
  return true;
}

double Chi2(const Eigen::Matrix3d& R, const RayMatch& match) {
  const Eigen::Vector3d q = R * match.a.homogeneous();
  if (!(q.z() > 0)) return std::numeric_limits<double>::infinity();
  return (match.b - q.head<2>() / q.z()).squaredNorm() /
         (match.sigma_a * match.sigma_a + match.sigma_b * match.sigma_b);
}

class RotationProblem {
 public:
  using Model = Eigen::Matrix3d;
  static constexpr std::size_t kSampleSize = 2;

  explicit RotationProblem(std::span<const RayMatch> matches) : matches_(matches) {}

  std::size_t size() const { return matches_.size(); }

  // The frames of (bisector, normal of the plane) of the two rays in each camera.
  std::vector<Model> Solve(const std::array<std::size_t, 2>& sample) const {
    const auto frame = [&](Eigen::Vector2d RayMatch::*side, Eigen::Matrix3d& axes) {
      const Eigen::Vector3d p = (matches_[sample[0]].*side).homogeneous().normalized();
      const Eigen::Vector3d q = (matches_[sample[1]].*side).homogeneous().normalized();
      const Eigen::Vector3d normal = p.cross(q);
      if (!(normal.norm() > 1e-6)) return false;
      axes.col(0) = (p + q).normalized();
      axes.col(1) = normal.normalized();
      axes.col(2) = axes.col(0).cross(axes.col(1));
      return true;
    };
    Eigen::Matrix3d in_a;
    Eigen::Matrix3d in_b;
    if (!frame(&RayMatch::a, in_a) || !frame(&RayMatch::b, in_b)) return {};
    return {in_b * in_a.transpose()};
  }

  double Cost(const Model& R, double limit) const {
    double sum = 0;
    for (const RayMatch& match : matches_) {
      sum += std::min(Chi2(R, match), kChi2TwoDof95);
      if (sum > limit) break;
    }
    return sum;
  }

  int Inliers(const Model& R) const {
    return static_cast<int>(std::count_if(matches_.begin(), matches_.end(), [&](const auto& m) {
      return Chi2(R, m) < kChi2TwoDof95;
    }));
  }
  double InlierRatio(const Model& R) const {
    return static_cast<double>(Inliers(R)) / static_cast<double>(size());
  }

  // Gauss-Newton with the weights of Geman and McClure.
  Model Improve(Model R) const {
    for (int i = 0; i < 5; ++i) {
      Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
      Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
      for (const RayMatch& match : matches_) {
        TransferResidual r;
        if (!Evaluate(R, match, r)) continue;
        const double part = 1 / (1 + r.value.squaredNorm() / (4 * kChi2TwoDof95));
        information += part * part * r.jacobian.transpose() * r.jacobian;
        gradient += part * part * r.jacobian.transpose() * r.value;
      }
      const Eigen::Vector3d step = -information.ldlt().solve(gradient);
      if (!step.allFinite()) break;
      R = (ExpSo3(step) * Eigen::Quaterniond(R)).normalized().toRotationMatrix();
      if (step.norm() < 1e-8) break;
    }
    return R;
  }

  bool Same(const Model&, const Model&) const { return true; }

 private:
  std::span<const RayMatch> matches_;
};

}  // namespace

RotationFit FitRotation(std::span<const RayMatch> matches, Rng& rng) {
  RotationFit fit;
  const RotationProblem problem(matches);
  const auto best = Ransac<RotationProblem>(problem, {.max_iterations = kMaxSamples}, 1)
                        .Run(std::array{Eigen::Matrix3d(Eigen::Matrix3d::Identity())}, rng);
  if (best.empty()) return fit;
  const Eigen::Matrix3d& R = best.front().model;
  fit.b_from_a = Eigen::Quaterniond(R).normalized();
  fit.cost = best.front().cost;
  fit.inliers = problem.Inliers(R);
  fit.median_residual = MedianParallax(matches, fit.b_from_a);
  return fit;
}

double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles;
  angles.reserve(matches.size());
  for (const RayMatch& match : matches) {
    const Eigen::Vector3d q = b_from_a * match.a.homogeneous();
    const Eigen::Vector3d b = match.b.homogeneous();
    angles.push_back(math::Atan2(q.cross(b).norm(), q.dot(b)));
  }
  return UpperMedian(std::move(angles));
}

}  // namespace plumbline
