// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/triangulation.h"

#include "plumbline/base/largest_angle.h"
#include "plumbline/geometry/eigenpairs.h"
#include "plumbline/geometry/symmetric_system.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

using Row = Eigen::RowVector3d;

// Returns the camera centres in the world, two for a view with a disparity.
std::vector<Eigen::Vector3d> CentresOf(const RectifiedCamera& camera,
                                       std::span<const PointView> views) {
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(2 * views.size());
  for (const PointView& view : views) {
    const Rigid3 world_from_cam = Inverse(view.cam_from_world);
    centres.push_back(world_from_cam.translation);
    if (view.disparity) centres.push_back(world_from_cam * Eigen::Vector3d(camera.baseline, 0, 0));
  }
  return centres;
}

double LargestParallax(const std::vector<Eigen::Vector3d>& centres, const Eigen::Vector3d& point) {
  LargestAngle largest;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    for (std::size_t j = i + 1; j < centres.size(); ++j) {
      const Eigen::Vector3d a = centres[i] - point;
      const Eigen::Vector3d b = centres[j] - point;
      largest.Add(a.cross(b).norm(), a.dot(b));
    }
  }
  return largest.angle();
}

// Solves homogeneous least squares on u (row 3) - (row 1) = 0 and the like, in the first camera's
// frame.
std::optional<Eigen::Vector3d> LinearPoint(const RectifiedCamera& camera,
                                           std::span<const PointView> views) {
  const Rigid3 world_from_local = Inverse(views.front().cam_from_world);
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  const auto add = [&normal](const Eigen::RowVector4d& row, double sigma) {
    normal += row.transpose() * row / (sigma * sigma);
  };
  for (const PointView& view : views) {
    const Rigid3 cam_from_local = view.cam_from_world * world_from_local;
    const Eigen::Matrix4d P = cam_from_local.Matrix();
    const Eigen::Vector3d ray = camera.Unproject(view.px);
    add(P.row(0) - ray.x() * P.row(2), view.sigma_px);
    add(P.row(1) - ray.y() * P.row(2), view.sigma_px);
    if (view.disparity) {  // disparity z = fx baseline
      Eigen::RowVector4d row = view.disparity->px / camera.fx * P.row(2);
      row(3) -= camera.baseline;
      add(row, view.disparity->sigma_px);
    }
  }
  const Eigen::Vector4d x = EigenpairsOf<4>(normal).vectors.col(0);
  if (!(std::abs(x(3)) > 1e-12 * x.head<3>().norm())) return std::nullopt;
  return world_from_local * Eigen::Vector3d(x.head<3>() / x(3));
}

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double chi2 = 0;
  int residuals = 0;

  void Add(double residual, const Row& J, double sigma) {
    const double weight = 1 / (sigma * sigma);
    information += weight * J.transpose() * J;
    gradient += weight * residual * J.transpose();
    chi2 += weight * residual * residual;
    ++residuals;
  }
};

std::vector<Eigen::Matrix3d> RotationsOf(std::span<const PointView> views) {
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(views.size());
  for (const PointView& view : views) {
    rotations.push_back(view.cam_from_world.rotation.toRotationMatrix());
  }
  return rotations;
}

// Returns nullopt when the point is not in front of every camera.
std::optional<NormalEquations> Linearize(const RectifiedCamera& camera,
                                         std::span<const PointView> views,
                                         const std::vector<Eigen::Matrix3d>& rotations,
                                         const Eigen::Vector3d& point) {
  NormalEquations equations;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PointView& view = views[i];
    const Eigen::Vector3d p = view.cam_from_world * point;
    if (!(p.z() > 0)) return std::nullopt;
    const Eigen::Matrix3d& R = rotations[i];
    const double inverse_z = 1 / p.z();
    const Eigen::Vector2d error = camera.Project(p) - view.px;
    const Row J_x = camera.fx * inverse_z * (R.row(0) - p.x() * inverse_z * R.row(2));
    const Row J_y = camera.fy * inverse_z * (R.row(1) - p.y() * inverse_z * R.row(2));
    equations.Add(error.x(), J_x, view.sigma_px);
    equations.Add(error.y(), J_y, view.sigma_px);
    if (view.disparity) {
      const double predicted = camera.DisparityFromDepth(p.z());
      const Row J_disparity = -predicted * inverse_z * R.row(2);
      equations.Add(predicted - view.disparity->px, J_disparity, view.disparity->sigma_px);
    }
  }
  return equations;
}

}  // namespace

PointEstimate Transform(const Rigid3& b_from_a, const PointEstimate& point_in_a) {
  const Eigen::Matrix3d R = b_from_a.rotation.toRotationMatrix();
  return {b_from_a * point_in_a.position, R * point_in_a.covariance * R.transpose()};
}

Expected<TriangulatedPoint, PointTriangulationFailure> TriangulatePoint(
    const RectifiedCamera& camera,
    std::span<const PointView> views,
    const PointTriangulationOptions& options) {
  using enum PointTriangulationFailure;
  const std::vector<Eigen::Vector3d> centres = CentresOf(camera, views);
  if (centres.size() < 2) return kTooFewViews;
  const std::optional<Eigen::Vector3d> start = LinearPoint(camera, views);
  if (!start) return kSmallParallax;  // the point is at infinity
  Eigen::Vector3d point = *start;
  const std::vector<Eigen::Matrix3d> rotations = RotationsOf(views);
  std::optional<NormalEquations> equations = Linearize(camera, views, rotations, point);
  if (!equations) return kBehindCamera;
  for (int i = 0; i < options.max_iterations; ++i) {
    const Eigen::Vector3d step = SolveSymmetric<3>(equations->information, equations->gradient);
    const Eigen::Vector3d trial = point - step;
    std::optional<NormalEquations> trial_equations = Linearize(camera, views, rotations, trial);
    // The loop also ends if the step is not finite.
    if (!trial_equations || !(trial_equations->chi2 <= equations->chi2)) break;
    point = trial;
    equations = std::move(trial_equations);
    if (step.norm() < 1e-10 * (point - centres.front()).norm()) break;
  }
  TriangulatedPoint result;
  result.parallax = LargestParallax(centres, point);
  if (!(result.parallax >= options.min_parallax)) return kSmallParallax;
  const auto covariance = InverseOfInformation<3>(equations->information, 1e-15);
  if (!covariance) return kSingular;
  result.point = {point, *covariance};
  result.chi2 = equations->chi2;
  result.residuals = equations->residuals;
  return result;
}

}  // namespace plumbline
