// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/landmark_from_frame.h"

#include "plumbline/base/error.h"
#include "plumbline/base/statistics.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/line_cutting/cutting_problem.h"
#include "plumbline/matching/measurements.h"

#include <cmath>
#include <vector>

namespace plumbline {
namespace {

bool DepthIsKnown(const Disparity& disparity, double max_relative_sigma) {
  return disparity.px > 0 && disparity.sigma_px <= max_relative_sigma * disparity.px;
}

// Returns the disparities of the ends of a line that the right image shows, too.
std::optional<LineEndDisparity> MeasuredEnds(const Frame& frame,
                                             std::size_t i,
                                             double flat_angle_deg) {
  const Features& features = frame.features();
  if (!features.line_right[i]) return std::nullopt;
  return LineEndDisparities(features.lines[i], *features.line_right[i], flat_angle_deg);
}

// Returns the line through the ends of feature i at these disparities.
LineModel LineAt(const RectifiedCamera& camera,
                 const Frame& frame,
                 std::size_t i,
                 const LineEndDisparity& ends) {
  const LineFeature& feature = frame.features().lines[i];
  const Rigid3 world_from_cam = Inverse(frame.cam_from_world);
  const auto lift = [&](const Eigen::Vector2d& px, const Disparity& disparity) {
    return world_from_cam * (camera.DepthFromDisparity(disparity.px) * camera.Unproject(px));
  };
  const Eigen::Vector3d start = lift(feature.segment.start, ends.start);
  const Eigen::Vector3d end = lift(feature.segment.end, ends.end);
  LineModel model;
  model.line = LineThroughPoints(start, end);
  model.start = model.line.ParameterOf(start);
  model.end = model.line.ParameterOf(end);
  model.view_direction = (0.5 * (start + end) - world_from_cam.translation).normalized();
  model.descriptor = feature.descriptor;
  model.information = LineInformation(camera, frame, i, model.line);
  return model;
}

Disparity Average(const Disparity& a, const Disparity& b) {
  const double wa = 1 / (a.sigma_px * a.sigma_px);
  const double wb = 1 / (b.sigma_px * b.sigma_px);
  return {(wa * a.px + wb * b.px) / (wa + wb), 1 / std::sqrt(wa + wb)};
}

// Returns the information of a known distance from the camera about a line. The point at parameter
// t is known along the ray with a deviation relative to its distance; only the part of the ray
// across the line counts.
Eigen::Matrix4d DepthInformation(const PluckerLine& line,
                                 double t,
                                 const Eigen::Vector3d& camera_centre,
                                 double relative_sigma) {
  const Eigen::Vector3d ray = line.PointAt(t) - camera_centre;
  const Eigen::Vector3d across = ray - ray.dot(line.direction) * line.direction;
  const double shift = across.norm();
  const Eigen::RowVector4d row = across.transpose() / (shift * shift * relative_sigma) *
                                 ShiftJacobian(line, ToOrthonormal(line), t);
  return row.transpose() * row;
}

}  // namespace

std::optional<PointModel> PointFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i,
                                         double max_relative_sigma) {
  const auto& disparity = frame.features().point_disparity[i];
  if (!disparity || !DepthIsKnown(*disparity, max_relative_sigma)) return std::nullopt;
  const PointFeature& feature = frame.features().points[i];
  const Eigen::Vector3d in_camera =
      camera.DepthFromDisparity(disparity->px) * camera.Unproject(feature.px);
  const Rigid3 world_from_cam = Inverse(frame.cam_from_world);
  PointModel point;
  point.position = world_from_cam * in_camera;
  point.view_direction = world_from_cam.rotation * in_camera.normalized();
  point.reference_distance = in_camera.norm();
  point.reference_octave = feature.octave;
  point.descriptor = feature.descriptor;
  return point;
}

Eigen::Matrix3d PointCovarianceFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i) {
  const PointFeature& feature = frame.features().points[i];
  const auto& disparity = frame.features().point_disparity[i];
  PLUMBLINE_CHECK(disparity.has_value(), "a point without disparity has no place");
  const Eigen::Vector3d in_camera =
      camera.DepthFromDisparity(disparity->px) * camera.Unproject(feature.px);
  const Eigen::Matrix3d R = Inverse(frame.cam_from_world).rotation.toRotationMatrix();
  return R * CovarianceFromDisparity(camera, in_camera, feature.sigma_px, disparity->sigma_px) *
         R.transpose();
}

std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma) {
  const auto ends = MeasuredEnds(frame, i, kFlatAngleDeg);
  if (!ends || !DepthIsKnown(ends->start, max_relative_sigma) ||
      !DepthIsKnown(ends->end, max_relative_sigma)) {
    return std::nullopt;
  }
  return LineAt(camera, frame, i, *ends);
}

std::optional<Disparity> SceneDisparity(const Frame& frame) {
  constexpr double kRelativeSigma = 0.5;
  std::vector<double> disparities;
  for (const auto& point : frame.features().point_disparity) {
    if (point && DepthIsKnown(*point, kRelativeSigma)) disparities.push_back(point->px);
  }
  for (std::size_t i = 0; i < frame.lines.size(); ++i) {
    const auto ends = MeasuredEnds(frame, i, kFlatAngleDeg);
    if (!ends) continue;
    for (const Disparity& end : {ends->start, ends->end}) {
      if (DepthIsKnown(end, kRelativeSigma)) disparities.push_back(end.px);
    }
  }
  if (disparities.empty()) return std::nullopt;
  const double median = UpperMedian(std::span<double>(disparities));
  return Disparity{median, kRelativeSigma * median};
}

LineModel LineAtSceneDepth(const RectifiedCamera& camera,
                           const Frame& frame,
                           std::size_t i,
                           const Disparity& scene) {
  const auto measured = MeasuredEnds(frame, i, 0);
  const LineEndDisparity ends =
      measured ? LineEndDisparity{Average(measured->start, scene), Average(measured->end, scene)}
               : LineEndDisparity{scene, scene};
  LineModel model = LineAt(camera, frame, i, ends);
  const Eigen::Vector3d centre = Inverse(frame.cam_from_world).translation;
  for (const double t : {model.start, model.end}) {
    model.information += DepthInformation(model.line, t, centre, scene.sigma_px / scene.px);
  }
  return model;
}

}  // namespace plumbline
