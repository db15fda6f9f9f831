// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_from_ends.h"

#include "plumbline/base/statistics.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/tracking/projected_ends.h"

namespace plumbline {
namespace {

constexpr double kMinParallax = 0.02;  // rad; its cosine is 0.9998

// A segment and the camera that measured it.
struct ImageOfLine {
  Rigid3 left_from_world;
  LineMeasurement measurement;
  double sigma_px = 1;
};

std::vector<ImageOfLine> ImagesOf(const Map& map, const std::vector<LineViewOf>& views) {
  std::vector<ImageOfLine> images;
  for (const LineViewOf& view : views) {
    const Frame& frame = map.Find(view.keyframe)->frame;
    const Features& features = frame.features();
    constexpr LineWeighting kMeasured = LineWeighting::kCovariance;
    images.push_back({frame.cam_from_world,
                      MeasureLeftLine(features, view.feature, kMeasured),
                      features.lines[view.feature].sigma_px});
    const auto right = MeasureRightLine(features, view.feature, kMeasured);
    if (!right) continue;
    images.push_back({frame.cam_from_world, *right, features.line_right[view.feature]->sigma_px});
  }
  return images;
}

std::optional<Eigen::Vector3d> Triangulate(const RectifiedCamera& camera,
                                           const std::vector<ImageOfLine>& images,
                                           Eigen::Vector2d Segment2::*end) {
  std::vector<PointView> views;
  for (const ImageOfLine& image : images) {
    Rigid3 cam_from_world = image.left_from_world;
    cam_from_world.translation.x() += camera.ShiftInto(image.measurement.camera);
    views.push_back({cam_from_world, image.measurement.segment.*end, image.sigma_px, std::nullopt});
  }
  const auto found = TriangulatePoint(camera, views, {.min_angle = kMinParallax});
  if (!found) return std::nullopt;
  return found->position;
}

bool StaysOnMeasuredLine(const RectifiedCamera& camera,
                         const ImageOfLine& image,
                         const Segment3& ends) {
  Eigen::Vector2d r;
  const Rigid3& T = image.left_from_world;
  return WhitenedEndDistances(
             MakeProjectedEndsTerm(camera, image.measurement), {T * ends.start, T * ends.end}, r) &&
         r.squaredNorm() <= kChi2TwoDof95;
}

}  // namespace

std::optional<MapLine> LineFromTwoEnds(const Map& map,
                                       const RectifiedCamera& camera,
                                       const std::vector<LineViewOf>& views) {
  if (views.size() > 2) return std::nullopt;
  const std::vector<ImageOfLine> images = ImagesOf(map, views);
  const auto start = Triangulate(camera, images, &Segment2::start);
  const auto end = Triangulate(camera, images, &Segment2::end);
  if (!start || !end || *start == *end) return std::nullopt;
  for (const ImageOfLine& image : images) {
    if (!StaysOnMeasuredLine(camera, image, {*start, *end})) return std::nullopt;
  }
  const PluckerLine line = LineThroughPoints(*start, *end);
  return MapLineFrom(map, camera, views, line, {line.ParameterOf(*start), line.ParameterOf(*end)});
}

}  // namespace plumbline
