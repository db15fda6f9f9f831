// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/triangulation.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/geometry/trimming.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/SVD>

namespace plumbline {
namespace {

// The largest of many angles in [0, pi], each given by the two arguments of atan2. An angle is
// computed only if it may be the largest: atan2 takes ten times as long as that test.
class LargestAngle {
 public:
  // Adds an angle. Returns true if atan2(across, along) exceeds 0 and all earlier angles. Requires
  // across >= 0.
  bool Add(double across, double along) {
    // If two angles are nearly equal, the rounded angles decide.
    constexpr double kClearly = 1e-12;
    const double ahead = across * along_, behind = along * across_;
    if (ahead - behind < -kClearly * (std::abs(ahead) + std::abs(behind))) return false;
    const double angle = math::Atan2(across, along);
    if (!(angle > angle_)) return false;
    angle_ = angle;
    across_ = across;
    along_ = along;
    return true;
  }

  double angle() const { return angle_; }

 private:
  double angle_ = 0;
  double across_ = 0, along_ = 1;  // arguments of atan2 for angle_
};

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

Expected<TriangulatedPoint, PointTriangulationFailure> TriangulatePoint(
    const RectifiedCamera& camera,
    std::span<const PointView> views,
    const TriangulationOptions& options) {
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
  if (!(result.parallax >= options.min_angle)) return kSmallParallax;
  const auto covariance = InverseOfInformation<3>(equations->information, 1e-15);
  if (!covariance) return kSingular;
  result.position = point;
  result.covariance = *covariance;
  result.chi2 = equations->chi2;
  result.residuals = equations->residuals;
  return result;
}

namespace {

// Share of the moment, |m| / sqrt(|m|^2 + |d|^2), below which a line counts as going through the
// origin.
constexpr double kThroughOrigin = 1e-9;

struct LineEquations {
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
LineEquations Linearize(std::span<const LineView> views,
                        const std::vector<Eigen::Matrix<double, 3, 6>>& image_from_line,
                        const OrthonormalLine& line) {
  const Eigen::Matrix<double, 6, 1> homogeneous = line.Homogeneous();
  const Eigen::Matrix<double, 6, 4> J_homogeneous = HomogeneousJacobian(line);
  LineEquations equations;
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
  LineEquations equations = Linearize(views, image_from_line, line);
  for (int i = 0; i < max_iterations; ++i) {
    const Eigen::Vector4d step = SolveSymmetric<4>(equations.information, equations.gradient);
    const OrthonormalLine trial = Retract(line, -step);
    const LineEquations trial_equations = Linearize(views, image_from_line, trial);
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
    const TriangulationOptions& options) {
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
  if (!(pair.angle >= options.min_angle)) return kParallelPlanes;
  const std::optional<PluckerLine> linear = LinearLine(camera, local, planes, pair);
  if (!linear) return kParallelPlanes;
  if (!(ToOrthonormal(*linear).w.x() > kThroughOrigin)) return kSingular;
  const PluckerLine refined =
      ToPlucker(Refine(camera, local, ToOrthonormal(*linear), options.max_iterations));
  const std::optional<PluckerLine> directed = DirectAsFirst(camera, local, refined);
  if (!directed) return kBehindCamera;

  const PluckerLine line = Transform(world_from_local, *directed);
  const LineEquations equations =
      Linearize(views, ImageFromLine(camera, views), ToOrthonormal(line));
  if (!(equations.worst <= options.max_residual_sigma)) return kInconsistentViews;
  const auto covariance = InverseOfInformation<4>(equations.information, 1e-15);
  if (!covariance) return kSingular;
  TriangulatedLine result;
  result.line = line;
  result.covariance = *covariance;
  result.chi2 = equations.chi2;
  result.residuals = static_cast<int>(2 * views.size());
  return result;
}

}  // namespace plumbline
