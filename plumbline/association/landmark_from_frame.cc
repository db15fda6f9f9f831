// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/association/landmark_from_frame.h"

#include "plumbline/association/line_information.h"
#include "plumbline/association/measurements.h"
#include "plumbline/features/match_lines.h"

namespace plumbline {
namespace {

bool DepthIsKnown(const Disparity& disparity, double max_relative_sigma) {
  return disparity.px > 0 && disparity.sigma_px <= max_relative_sigma * disparity.px;
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

std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma) {
  const Features& features = frame.features();
  const LineFeature& feature = features.lines[i];
  if (!features.line_right[i]) return std::nullopt;
  const auto ends = LineEndDisparities(feature, *features.line_right[i]);
  if (!ends || !DepthIsKnown(ends->start, max_relative_sigma) ||
      !DepthIsKnown(ends->end, max_relative_sigma)) {
    return std::nullopt;
  }
  const Rigid3 world_from_cam = Inverse(frame.cam_from_world);
  const auto lift = [&](const Eigen::Vector2d& px, const Disparity& disparity) {
    return world_from_cam * (camera.DepthFromDisparity(disparity.px) * camera.Unproject(px));
  };
  const Eigen::Vector3d start = lift(feature.segment.start, ends->start);
  const Eigen::Vector3d end = lift(feature.segment.end, ends->end);
  LineModel model;
  model.line = LineThroughPoints(start, end);
  model.start = model.line.ParameterOf(start);
  model.end = model.line.ParameterOf(end);
  model.view_direction = (0.5 * (start + end) - world_from_cam.translation).normalized();
  model.descriptor = feature.descriptor;
  model.information = LineInformation(camera, frame, i, model.line);
  return model;
}

}  // namespace plumbline
