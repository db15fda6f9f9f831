// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/epipolar.h"

#include <cmath>

namespace plumbline {
namespace {

// Where an image line cuts the line of a segment.
std::optional<Eigen::Vector2d> CutOf(const Eigen::Vector3d& line,
                                     const Segment2& segment,
                                     double min_angle) {
  const Eigen::Vector2d normal = line.head<2>();
  const Eigen::Vector2d direction = segment.Direction();
  const double sine = normal.dot(direction);
  if (!(std::abs(sine) > std::sin(min_angle) * normal.norm())) return std::nullopt;
  const double along = -line.dot(segment.start.homogeneous()) / sine;
  return segment.start + along * direction;
}

}  // namespace

Eigen::Matrix3d FundamentalMatrix(const RectifiedCamera& camera, const Rigid3& b_from_a) {
  Eigen::Matrix3d K_inverse;
  K_inverse << 1 / camera.fx, 0, -camera.cx / camera.fx, 0, 1 / camera.fy, -camera.cy / camera.fy,
      0, 0, 1;
  return K_inverse.transpose() * EssentialMatrix(b_from_a) * K_inverse;
}

std::optional<double> SquaredSampsonDistance(const Eigen::Matrix3d& fundamental,
                                             const Eigen::Vector2d& px_a,
                                             const Eigen::Vector2d& px_b) {
  const Eigen::Vector3d line_in_b = fundamental * px_a.homogeneous();
  const Eigen::Vector3d line_in_a = fundamental.transpose() * px_b.homogeneous();
  const double error = px_b.homogeneous().dot(line_in_b);
  const double gradient = line_in_b.head<2>().squaredNorm() + line_in_a.head<2>().squaredNorm();
  if (!(gradient > 0)) return std::nullopt;
  return error * error / gradient;
}

std::optional<double> EpipolarOverlap(const Eigen::Matrix3d& fundamental,
                                      const Segment2& segment_a,
                                      const Segment2& segment_b,
                                      double min_angle) {
  if (!(segment_a.Length() > 0) || !(segment_b.Length() > 0)) return std::nullopt;
  const auto start = CutOf(fundamental * segment_a.start.homogeneous(), segment_b, min_angle);
  const auto end = CutOf(fundamental * segment_a.end.homogeneous(), segment_b, min_angle);
  if (!start || !end) return std::nullopt;
  return OverlapRatio(segment_b, {*start, *end});
}

}  // namespace plumbline
