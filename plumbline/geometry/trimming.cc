// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/trimming.h"

#include <cmath>

namespace plumbline {

std::optional<double> TrimmedParameter(const RectifiedCamera& camera,
                                       const Rigid3& cam_from_world,
                                       const PluckerLine& line_in_world,
                                       const Eigen::Vector2d& px) {
  constexpr double kParallel = 1e-9;  // sine of an angle
  const PluckerLine line = Transform(cam_from_world, line_in_world);
  const Eigen::Vector3d image_line = camera.ProjectMoment(line.moment);
  const double scale = image_line.head<2>().norm();
  // The line is seen end-on, or on the horizon of the image plane.
  if (!(scale > kParallel * image_line.norm()) || !(line.moment.norm() > 0)) return std::nullopt;
  const Eigen::Vector3d l = image_line / scale;
  const Eigen::Vector2d foot = px - LineDistance(l, px) * l.head<2>();  // eq. 26, 27
  const double c = l.x() * foot.y() - l.y() * foot.x();
  // The normal of the plane through the centre and the image line (l2, -l1, c) is K^T times that
  // line.
  const Eigen::Vector3d normal(
      camera.fx * l.y(), -camera.fy * l.x(), camera.cx * l.y() - camera.cy * l.x() + c);
  const double incidence = normal.dot(line.direction);
  if (!(std::abs(incidence) > kParallel * normal.norm())) return std::nullopt;
  // eq. 30: n x (X x d) = X (n.d) - d (n.X) with n.X = 0.
  const Eigen::Vector3d point = normal.cross(line.moment) / incidence;
  if (!(point.z() > 0)) return std::nullopt;
  return line_in_world.ParameterOf(Inverse(cam_from_world) * point);
}

std::optional<LineInterval> TrimToSegment(const RectifiedCamera& camera,
                                          const Rigid3& cam_from_world,
                                          const PluckerLine& line_in_world,
                                          const Segment2& segment) {
  const auto start = TrimmedParameter(camera, cam_from_world, line_in_world, segment.start);
  if (!start) return std::nullopt;
  const auto end = TrimmedParameter(camera, cam_from_world, line_in_world, segment.end);
  if (!end) return std::nullopt;
  return LineInterval{*start, *end};
}

}  // namespace plumbline
