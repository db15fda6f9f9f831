// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/absolute_pose.h"

#include "plumbline/base/random.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/solvers/polynomial.h"
#include "plumbline/solvers/ransac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Three = std::array<Vector3d, 3>;

// Returns axes along the first side of a triangle, across it in its plane, and normal to it.
Matrix3d AxesOf(const Three& corners) {
  Matrix3d axes;
  axes.col(0) = (corners[1] - corners[0]).normalized();
  axes.col(2) = axes.col(0).cross(corners[2] - corners[0]).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

// Returns the poses that project three points to three unit directions, at most four (Grunert 1841,
// in the form of Haralick et al., IJCV 1994). With the distances s and its multiples u s and v s,
// the law of cosines for the three sides leaves a polynomial of degree four in v.
std::vector<Rigid3> PosesOfThree(const Three& world, const Three& rays) {
  const double a2 = (world[1] - world[2]).squaredNorm();
  const double b2 = (world[0] - world[2]).squaredNorm();
  const double c2 = (world[0] - world[1]).squaredNorm();
  if (!(a2 > 0 && b2 > 0 && c2 > 0)) return {};
  const double alpha = rays[1].dot(rays[2]);  // cosines of the angles between the rays
  const double beta = rays[0].dot(rays[2]);
  const double gamma = rays[0].dot(rays[1]);
  const double d = (a2 - c2) / b2;
  const double e = (a2 + c2) / b2;
  const double a = a2 / b2;
  const double c = c2 / b2;
  const std::array<double, 5> quartic = {
      (1 + d) * (1 + d) - 4 * a * gamma * gamma,
      4 * (-d * (1 + d) * beta + 2 * a * gamma * gamma * beta - (1 - e) * alpha * gamma),
      2 * (d * d - 1 + 2 * d * d * beta * beta + 2 * (1 - c) * alpha * alpha -
           4 * e * alpha * beta * gamma + 2 * (1 - a) * gamma * gamma),
      4 * (d * (1 - d) * beta - (1 - e) * alpha * gamma + 2 * c * alpha * alpha * beta),
      (d - 1) * (d - 1) - 4 * c * alpha * alpha};
  const Matrix3d world_axes = AxesOf(world);
  if (!world_axes.allFinite() || world_axes.col(2).squaredNorm() < 0.5) return {};
  std::vector<Rigid3> poses;
  for (const double v : RealRoots(quartic)) {
    const double divisor = 2 * (gamma - v * alpha);
    const double u = ((d - 1) * v * v - 2 * d * beta * v + 1 + d) / divisor;
    const double s = std::sqrt(b2 / (1 + v * v - 2 * v * beta));
    if (!(v > 0 && u > 0) || !std::isfinite(u) || !std::isfinite(s)) continue;
    const Three camera = {s * rays[0], u * s * rays[1], v * s * rays[2]};
    const Matrix3d rotation = AxesOf(camera) * world_axes.transpose();
    if (!rotation.allFinite()) continue;
    const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
    poses.push_back({q, camera[0] - q * world[0]});
  }
  return poses;
}

// The problem as RANSAC needs it. Errors are in pixels; those of points behind the camera are
// infinite.
class PointsProblem {
 public:
  using Model = Rigid3;  // cam_from_world
  static constexpr std::size_t kSampleSize = 3;

  PointsProblem(const RectifiedCamera& camera,
                std::span<const PointInImage> points,
                double max_error_px)
      : camera_(camera), points_(points), limit_(max_error_px * max_error_px) {}

  std::size_t size() const { return points_.size(); }

  std::vector<Rigid3> Solve(const std::array<std::size_t, kSampleSize>& sample) const {
    Three world, rays;
    for (std::size_t i = 0; i < kSampleSize; ++i) {
      world[i] = points_[sample[i]].world;
      rays[i] = camera_.Unproject(points_[sample[i]].px).normalized();
    }
    return PosesOfThree(world, rays);
  }

  double Cost(const Rigid3& pose, double limit) const {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size() && sum <= limit; ++i) {
      sum += std::min(limit_, SquaredError(pose, points_[i]));
    }
    return sum;
  }

  std::size_t Inliers(const Rigid3& pose) const {
    return static_cast<std::size_t>(
        std::count_if(points_.begin(), points_.end(), [&](const PointInImage& point) {
          return SquaredError(pose, point) < limit_;
        }));
  }
  double InlierRatio(const Rigid3& pose) const {
    return static_cast<double>(Inliers(pose)) / static_cast<double>(size());
  }

  // Improves a pose by Gauss-Newton on the points that agree, which may change on the way.
  Rigid3 Improve(const Rigid3& start) const {
    constexpr int kSteps = 5;
    Rigid3 pose = start;
    for (int i = 0; i < kSteps; ++i) {
      Matrix6d information = Matrix6d::Zero();
      Vector6d gradient = Vector6d::Zero();
      for (const PointInImage& point : points_) {
        if (SquaredError(pose, point) < limit_) AddTo(pose, point, information, gradient);
      }
      const Vector6d step = SolveSymmetric<6>(information, -gradient);
      if (!step.allFinite()) return start;
      pose = ExpSe3(step) * pose;
      if (step.norm() < 1e-10) break;
    }
    return pose;
  }

  bool Same(const Rigid3&, const Rigid3&) const { return true; }  // only the best pose is kept

 private:
  double SquaredError(const Rigid3& pose, const PointInImage& point) const {
    const Vector3d in_camera = pose * point.world;
    if (!(in_camera.z() > 0)) return std::numeric_limits<double>::infinity();
    return (camera_.Project(in_camera) - point.px).squaredNorm();
  }

  // Adds a point, with derivatives by the left perturbation exp([w, v]) of the pose.
  void AddTo(const Rigid3& pose,
             const PointInImage& point,
             Matrix6d& information,
             Vector6d& gradient) const {
    const Vector3d p = pose * point.world;
    const Vector2d error = camera_.Project(p) - point.px;
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << camera_.fx / p.z(), 0, -camera_.fx * p.x() / (p.z() * p.z()),  //
        0, camera_.fy / p.z(), -camera_.fy * p.y() / (p.z() * p.z());
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian << -by_point * Skew(p), by_point;
    information.noalias() += jacobian.transpose() * jacobian;
    gradient.noalias() += jacobian.transpose() * error;
  }

  const RectifiedCamera& camera_;
  std::span<const PointInImage> points_;
  double limit_;
};

}  // namespace

std::optional<Rigid3> PoseFromPoints(const RectifiedCamera& camera,
                                     const std::vector<PointInImage>& points,
                                     double max_error_px) {
  // Three points fix a pose, and any fourth one may agree by chance.
  constexpr std::size_t kMinPoints = 6;
  constexpr int kMostSamples = 300;
  if (points.size() < kMinPoints) return std::nullopt;
  const PointsProblem problem(camera, points, max_error_px);
  Rng rng(0, "absolute_pose");
  const auto found = Ransac<PointsProblem>(problem, kMostSamples, 1).Run({}, rng);
  if (found.empty() || problem.Inliers(found[0].model) < kMinPoints) return std::nullopt;
  return found[0].model;
}

}  // namespace plumbline
