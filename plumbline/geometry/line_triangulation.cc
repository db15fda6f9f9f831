// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/line_triangulation.h"

#include "plumbline/base/largest_angle.h"
#include "plumbline/geometry/symmetric_system.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/geometry/unit_rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/SVD>

namespace plumbline {
namespace {

// Share of the moment, |m| / sqrt(|m|^2 + |d|^2), below which a line counts as going through the
// origin.
constexpr double kThroughOrigin = 1e-9;

struct NormalEquations {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  double chi2 = 0;
  double worst = 0;  // largest |residual| / sigma
};

// Returns for each view the matrix that makes the image line of moment and direction.
std::vector<Eigen::Matrix<double, 3, 6>> ImageFromLine(const RectifiedCamera& camera,
                                                       std::span<const LineView> views) {
  Eigen::Matrix3d K;  // ProjectMoment
  for (int i = 0; i < 3; ++i) K.col(i) = camera.ProjectMoment(Eigen::Vector3d::Unit(i));
  std::vector<Eigen::Matrix<double, 3, 6>> out;
  out.reserve(views.size());
  for (const LineView& view : views) {
    const Eigen::Matrix3d R = view.cam_from_world.rotation.toRotationMatrix();
    Eigen::Matrix<double, 3, 6> moment_from_line;
    moment_from_line << R, Skew(view.cam_from_world.translation) * R;
    out.emplace_back(K * moment_from_line);
  }
  return out;
}

// Linearizes the two end point distances of each view (eq. 13, 16-18).
NormalEquations Linearize(std::span<const LineView> views,
                          const std::vector<Eigen::Matrix<double, 3, 6>>& image_from_line,
                          const OrthonormalLine& line) {
  const Eigen::Matrix<double, 6, 1> homogeneous = line.Homogeneous();
  const Eigen::Matrix<double, 6, 4> J_homogeneous = HomogeneousJacobian(line);
  NormalEquations equations;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const LineView& view = views[i];
    const Eigen::Vector3d l = image_from_line[i] * homogeneous;
    const Eigen::Matrix<double, 3, 4> J_l = image_from_line[i] * J_homogeneous;
    const double length = l.head<2>().norm();
    const std::array<Eigen::Vector2d, 2> ends = {view.segment.start, view.segment.end};
    for (const Eigen::Vector2d& px : ends) {
      const double distance = l.dot(px.homogeneous()) / length;
      Eigen::RowVector3d J_distance = px.homogeneous().transpose() / length;
      J_distance.head<2>() -= distance / (length * length) * l.head<2>().transpose();
      const Eigen::RowVector4d J = J_distance * J_l / view.sigma_px;
      const double residual = distance / view.sigma_px;
      equations.information += J.transpose() * J;
      equations.gradient += residual * J.transpose();
      equations.chi2 += residual * residual;
      // The comparison is written so that NaN is kept.
      if (!(std::abs(residual) <= equations.worst)) equations.worst = std::abs(residual);
    }
  }
  return equations;
}

struct PlanePair {
  std::size_t first = 0, second = 1;
  double angle = 0;
};

PlanePair WidestPair(const std::vector<Eigen::Vector4d>& planes) {
  // The normals have unit length. If their cosine is larger by more than rounding, the angle is
  // smaller.
  constexpr double kRounding = 1e-12;
  PlanePair widest;
  LargestAngle largest;
  double cosine = 1;  // cosine of the widest pair
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Eigen::Vector3d n1 = planes[i].head<3>();
      const Eigen::Vector3d n2 = planes[j].head<3>();
      const double along = std::abs(n1.dot(n2));
      if (along > cosine + kRounding) continue;
      if (!largest.Add(n1.cross(n2).norm(), along)) continue;
      widest = {i, j, largest.angle()};
      cosine = along;
    }
  }
  return widest;
}

// Returns the line of eq. 25 about an origin on the line through the widest pair of planes, with
// lengths relative to its distance from the camera.
std::optional<PluckerLine> LinearLine(const RectifiedCamera& camera,
                                      std::span<const LineView> views,
                                      const std::vector<Eigen::Vector4d>& planes,
                                      const PlanePair& pair) {
  auto pair_line = LineFromPlanes(planes[pair.first], planes[pair.second]);
  if (!pair_line || planes.size() == 2) return pair_line;
  const LineView& view = views[pair.first];
  const Eigen::Vector3d centre = Inverse(view.cam_from_world).translation;
  const Eigen::Vector3d origin = pair_line->PointAt(
      TrimmedParameter(camera, view.cam_from_world, *pair_line, view.segment.Midpoint())
          .value_or(pair_line->ParameterOf(centre)));
  const double unit = (origin - centre).norm();
  if (!(unit > 0)) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, 4> rows(static_cast<Eigen::Index>(planes.size()), 4);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector3d normal = planes[i].head<3>();
    const double weight = views[i].segment.Length() / views[i].sigma_px;
    rows.row(static_cast<Eigen::Index>(i)) << weight * normal.transpose(),
        weight * (planes[i](3) + normal.dot(origin)) / unit;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  const auto local = LineFromPlanes(svd.matrixV().col(0), svd.matrixV().col(1));
  if (!local) return std::nullopt;
  const Eigen::Vector3d point = origin + unit * local->Foot();
  return PluckerLine{point.cross(local->direction), local->direction};
}

// Refines the line by Gauss-Newton, as long as chi2 falls.
OrthonormalLine Refine(const RectifiedCamera& camera,
                       std::span<const LineView> views,
                       OrthonormalLine line,
                       int max_iterations) {
  const auto image_from_line = ImageFromLine(camera, views);
  NormalEquations equations = Linearize(views, image_from_line, line);
  for (int i = 0; i < max_iterations; ++i) {
    const Eigen::Vector4d step = SolveSymmetric<4>(equations.information, equations.gradient);
    const OrthonormalLine trial = Retract(line, -step);
    const NormalEquations trial_equations = Linearize(views, image_from_line, trial);
    if (!(trial_equations.chi2 < equations.chi2)) break;
    line = trial;
    equations = trial_equations;
    if (step.norm() < 1e-12) break;
  }
  return line;
}

// Directs the line as the first segment, by the places of its ends. Returns nullopt when one of
// them is behind a camera.
std::optional<PluckerLine> DirectAsFirst(const RectifiedCamera& camera,
                                         std::span<const LineView> views,
                                         PluckerLine line) {
  bool against = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto interval = TrimToSegment(camera, views[i].cam_from_world, line, views[i].segment);
    if (!interval) return std::nullopt;
    if (i == 0) against = interval->end < interval->start;
  }
  if (against) line = {-line.moment, -line.direction};
  return line;
}

}  // namespace

std::optional<Eigen::Vector4d> InterpretationPlane(const RectifiedCamera& camera,
                                                   const LineView& view) {
  if (!(view.segment.Length() > 0)) return std::nullopt;
  // The normal to the two rays is computed from points near the image, so that it is well
  // conditioned.
  const Eigen::Vector3d normal =
      camera.Unproject(view.segment.start).cross(camera.Unproject(view.segment.end)).normalized();
  Eigen::Vector4d plane;
  plane << view.cam_from_world.rotation.conjugate() * normal,
      normal.dot(view.cam_from_world.translation);
  return plane;
}

Expected<TriangulatedLine, LineTriangulationFailure> TriangulateLine(
    const RectifiedCamera& camera,
    std::span<const LineView> given,
    const LineTriangulationOptions& options) {
  using enum LineTriangulationFailure;
  if (given.size() < 2) return kTooFewViews;
  std::vector<LineView> views(given.begin(), given.end());
  for (LineView& view : views) {
    view.cam_from_world.rotation = UnitRotation(view.cam_from_world.rotation, "a view of the line");
  }
  // Everything is computed in the frame of the first camera: no line that this camera sees as a
  // line goes through that origin.
  const Rigid3 world_from_local = Inverse(views.front().cam_from_world);
  std::vector<LineView> local = views;
  std::vector<Eigen::Vector4d> planes;
  for (LineView& view : local) {
    view.cam_from_world = view.cam_from_world * world_from_local;
    const std::optional<Eigen::Vector4d> plane = InterpretationPlane(camera, view);
    if (!plane) return kEmptySegment;
    planes.push_back(*plane);
  }
  const PlanePair pair = WidestPair(planes);
  if (!(pair.angle >= options.min_plane_angle)) return kParallelPlanes;
  const std::optional<PluckerLine> linear = LinearLine(camera, local, planes, pair);
  if (!linear) return kParallelPlanes;
  if (!(ToOrthonormal(*linear).w.x() > kThroughOrigin)) return kSingular;
  const PluckerLine refined =
      ToPlucker(Refine(camera, local, ToOrthonormal(*linear), options.max_iterations));
  const std::optional<PluckerLine> directed = DirectAsFirst(camera, local, refined);
  if (!directed) return kBehindCamera;

  const PluckerLine line = Transform(world_from_local, *directed);
  const NormalEquations equations =
      Linearize(views, ImageFromLine(camera, views), ToOrthonormal(line));
  if (!(equations.worst <= options.max_residual_sigma)) return kInconsistentViews;
  const auto covariance = InverseOfInformation<4>(equations.information, 1e-15);
  if (!covariance) return kSingular;
  TriangulatedLine result;
  result.estimate = {line, *covariance};
  result.chi2 = equations.chi2;
  result.residuals = static_cast<int>(2 * views.size());
  return result;
}

}  // namespace plumbline
