// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/line_from_views.h"

#include "plumbline/geometry/triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <numbers>

namespace plumbline {
namespace {

// Least angle between the interpretation planes of a new line: smaller ones leave its depth open.
constexpr double kMinPlaneAngle = 2 * std::numbers::pi / 180;

// Returns all images of a line, left and right ones, as views of single cameras.
std::vector<LineView> ImageViews(const Map& map,
                                 const RectifiedCamera& camera,
                                 const std::vector<LineViewOf>& views) {
  std::vector<LineView> images;
  for (const LineViewOf& view : views) {
    const Frame& frame = map.Find(view.keyframe)->frame;
    const LineFeature& feature = frame.features().lines[view.feature];
    images.push_back({frame.cam_from_world, feature.segment, feature.sigma_px});
    if (const auto& right = frame.features().line_right[view.feature]) {
      images.push_back(
          {RightCamera(camera, frame.cam_from_world), right->segment, right->sigma_px});
    }
  }
  return images;
}

// Returns true if the ends of a line's segment are within a pixel of the projected line.
bool IsWithinAPixel(const RectifiedCamera& camera,
                    const Frame& frame,
                    std::size_t feature,
                    const PluckerLine& line) {
  constexpr double kFarthestPx = 1;
  LineMeasurement measurement;
  measurement.segment = frame.features().lines[feature].segment;
  const auto residual =
      EvaluateLine(camera, frame.cam_from_world, ToOrthonormal(line), measurement);
  return residual && residual->r.cwiseAbs().maxCoeff() < kFarthestPx;
}

// Returns true if ORB-SLAM would triangulate a point of the world from two views.
bool PassesAsPoint(const Frame& a, const Frame& b, const Eigen::Vector3d& point) {
  constexpr double kLargestCosine = 0.9998;
  const Eigen::Vector3d ray_a = point - Inverse(a.cam_from_world).translation;
  const Eigen::Vector3d ray_b = point - Inverse(b.cam_from_world).translation;
  return (a.cam_from_world * point).z() > 0 && (b.cam_from_world * point).z() > 0 &&
         ray_a.dot(ray_b) < kLargestCosine * ray_a.norm() * ray_b.norm();
}

}  // namespace

std::optional<MapLine> CheckedLineFromViews(const Map& map,
                                            const RectifiedCamera& camera,
                                            const std::vector<LineViewOf>& views) {
  auto line = LineFromViews(map, camera, views);
  if (!line) return std::nullopt;
  for (const LineViewOf& view : views) {
    const Frame& frame = map.Find(view.keyframe)->frame;
    if (!IsWithinAPixel(camera, frame, view.feature, line->line)) return std::nullopt;
  }
  if (views.size() > 2) return line;
  const Frame& first = map.Find(views.front().keyframe)->frame;
  const Frame& second = map.Find(views.back().keyframe)->frame;
  const Segment3 ends = line->Interval();
  const bool passes =
      PassesAsPoint(first, second, ends.start) && PassesAsPoint(first, second, ends.end);
  return passes ? line : std::nullopt;
}

std::optional<MapLine> LineFromViews(const Map& map,
                                     const RectifiedCamera& camera,
                                     const std::vector<LineViewOf>& views) {
  const auto triangulated =
      TriangulateLine(camera, ImageViews(map, camera, views), {.min_angle = kMinPlaneAngle});
  if (!triangulated) return std::nullopt;
  const PluckerLine& line = triangulated->line;
  const Frame& first = map.Find(views.front().keyframe)->frame;
  const Segment2& segment = first.features().lines[views.front().feature].segment;
  const auto interval = TrimToSegment(camera, first.cam_from_world, line, segment);
  if (!interval || interval->end <= interval->start) return std::nullopt;
  return MapLineFrom(map, camera, views, line, *interval);
}

MapLine MapLineFrom(const Map& map,
                    const RectifiedCamera& camera,
                    const std::vector<LineViewOf>& views,
                    const PluckerLine& of_line,
                    const LineInterval& interval) {
  MapLine line;
  line.line = of_line;
  line.start = interval.start;
  line.end = interval.end;
  const Frame& first = map.Find(views.front().keyframe)->frame;
  line.descriptor = first.features().lines[views.front().feature].descriptor;
  line.view_direction =
      (line.Interval().Midpoint() - Inverse(first.cam_from_world).translation).normalized();
  for (const LineViewOf& view : views) {
    line.observations.emplace(view.keyframe, static_cast<int>(view.feature));
    line.information +=
        LineInformation(camera, map.Find(view.keyframe)->frame, view.feature, line.line);
  }
  return line;
}

}  // namespace plumbline
