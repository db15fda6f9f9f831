// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/initial_map.h"

#include "plumbline/base/ids.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/bundle_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

constexpr double kMinParallax = 0.3 * kDegree;
// Largest standard deviations over the depth: of a point along its ray, of a line across itself.
constexpr double kMaxPointSigma = 0.3;
constexpr double kMaxLineSigma = 0.1;
// Lines may be nearer than the nearest point and farther than the farthest by this factor.
constexpr double kDepthMargin = 2;

const Features& FeaturesOf(const InitialView& view) { return view.frame.indexed->features; }

std::optional<InitialPoint> BuildPoint(const RectifiedCamera& camera,
                                       std::span<const InitialView> views,
                                       const FeatureTrack& track) {
  std::vector<PointView> measured;
  for (const InitialObservation& o : track) {
    const InitialView& view = views[Index(o.view)];
    const PointFeature& feature = FeaturesOf(view).points[Index(o.feature)];
    measured.push_back(
        {view.cam_from_world, o.px.value_or(feature.px), feature.sigma_px, std::nullopt});
  }
  const auto point = TriangulatePoint(camera, measured, {.min_angle = kMinParallax});
  if (!point || point->chi2 > Chi2Limit95(point->residuals - 3)) return std::nullopt;
  const Rigid3& cam_from_world = measured.front().cam_from_world;
  const Eigen::Matrix3d R = cam_from_world.rotation.toRotationMatrix();
  const Eigen::Matrix3d covariance = R * point->covariance * R.transpose();  // in the camera
  const double depth = (cam_from_world * point->position).z();
  if (std::sqrt(covariance(2, 2)) > kMaxPointSigma * depth) return std::nullopt;
  return InitialPoint{point->position, track};
}

struct DepthRange {
  double nearest = 0;
  double furthest = 0;
};

// Returns the range of depths in the first view in which lines may lie, from those of the points.
DepthRange LineDepths(const InitialMap& map) {
  DepthRange range{1e300, 0};
  for (const InitialPoint& point : map.points) {
    const double depth = (map.views.front().cam_from_world * point.position).z();
    range.nearest = std::min(range.nearest, depth);
    range.furthest = std::max(range.furthest, depth);
  }
  return {range.nearest / kDepthMargin, range.furthest * kDepthMargin};
}

// Returns the part of the line visible in any of the views; nullopt if it is behind one of them.
std::optional<Segment3> SeenPart(const RectifiedCamera& camera,
                                 std::span<const LineView> views,
                                 const PluckerLine& line) {
  std::optional<LineInterval> seen;
  for (const LineView& view : views) {
    const auto interval = TrimToSegment(camera, view.cam_from_world, line, view.segment);
    if (!interval || interval->end <= interval->start) return std::nullopt;
    if (!seen) seen = interval;
    seen = LineInterval{std::min(seen->start, interval->start), std::max(seen->end, interval->end)};
  }
  if (!seen) return std::nullopt;
  return SegmentOf(line, *seen);
}

std::vector<LineView> LineViews(std::span<const InitialView> views, const FeatureTrack& track) {
  std::vector<LineView> measured;
  for (const InitialObservation& o : track) {
    const InitialView& view = views[Index(o.view)];
    const LineFeature& feature = FeaturesOf(view).lines[Index(o.feature)];
    measured.push_back({view.cam_from_world, feature.segment, feature.sigma_px});
  }
  return measured;
}

// Returns the least angle of the planes: the ratio of depth to its standard deviation equals that
// of the angle of the planes to their noise.
double MinPlaneAngle(const RectifiedCamera& camera, std::span<const LineView> views) {
  double sigma = 0;
  for (const LineView& view : views) sigma = std::max(sigma, view.sigma_px);
  return std::numbers::sqrt2 * sigma / (0.5 * (camera.fx + camera.fy)) / kMaxLineSigma;
}

std::optional<InitialLine> BuildLine(const RectifiedCamera& camera,
                                     std::span<const InitialView> views,
                                     const FeatureTrack& track,
                                     const DepthRange& depths) {
  const std::vector<LineView> measured = LineViews(views, track);
  const auto line =
      TriangulateLine(camera, measured, {.min_angle = MinPlaneAngle(camera, measured)});
  if (!line) return std::nullopt;
  const auto segment = SeenPart(camera, measured, line->line);
  if (!segment) return std::nullopt;
  const Rigid3& cam_from_world = views.front().cam_from_world;
  for (const Eigen::Vector3d& end : {segment->start, segment->end}) {
    const double depth = (cam_from_world * end).z();
    if (depth < depths.nearest || depth > depths.furthest) return std::nullopt;
  }
  return InitialLine{line->line, *segment, track};
}

BaProblem MakeProblem(const RectifiedCamera& camera, const InitialMap& map) {
  BaProblem problem;
  problem.camera = camera;
  for (const InitialView& view : map.views) problem.poses.push_back({view.cam_from_world, false});
  problem.poses.front().fixed = true;
  for (const InitialPoint& point : map.points) {
    const int index = static_cast<int>(problem.points.size());
    problem.points.push_back(point.position);
    for (const InitialObservation& o : point.observations) {
      const Features& features = FeaturesOf(map.views[Index(o.view)]);
      PointMeasurement measured = MeasurePoint(features, Index(o.feature));
      if (o.px) measured.px = *o.px;
      problem.point_observations.push_back({o.view, index, measured});
    }
  }
  for (const InitialLine& line : map.lines) {
    const int index = static_cast<int>(problem.lines.size());
    problem.lines.push_back(ToOrthonormal(line.line));
    for (const InitialObservation& o : line.observations) {
      const Features& features = FeaturesOf(map.views[Index(o.view)]);
      problem.line_observations.push_back(
          {o.view, index, MeasureLeftLine(features, Index(o.feature), LineWeighting::kCovariance)});
    }
  }
  return problem;
}

// Removes the observations that are not inliers. `inliers` has one entry for each observation, in
// order.
template <class Landmark>
void KeepInliers(const std::vector<bool>& inliers, std::vector<Landmark>& landmarks) {
  std::size_t next = 0;
  for (Landmark& landmark : landmarks) {
    FeatureTrack kept;
    for (const InitialObservation& o : landmark.observations) {
      if (inliers[next++]) kept.push_back(o);
    }
    landmark.observations = std::move(kept);
  }
  std::erase_if(landmarks, [](const Landmark& l) { return l.observations.size() < 2; });
}

void TakeOver(const RectifiedCamera& camera, const BaResult& result, InitialMap& map) {
  for (std::size_t i = 0; i < map.views.size(); ++i) {
    map.views[i].cam_from_world = result.poses[i];
  }
  for (std::size_t i = 0; i < map.points.size(); ++i) map.points[i].position = result.points[i];
  for (std::size_t i = 0; i < map.lines.size(); ++i) map.lines[i].line = ToPlucker(result.lines[i]);
  KeepInliers(result.point_inliers, map.points);
  KeepInliers(result.line_inliers, map.lines);
  std::erase_if(map.lines, [&](InitialLine& line) {
    const auto segment = SeenPart(camera, LineViews(map.views, line.observations), line.line);
    if (segment) line.segment = *segment;
    return !segment;
  });
}

}  // namespace

InitialMap TriangulateMap(const RectifiedCamera& camera,
                          std::vector<InitialView> views,
                          std::span<const FeatureTrack> point_tracks,
                          std::span<const FeatureTrack> line_tracks) {
  InitialMap map;
  map.views = std::move(views);
  for (const FeatureTrack& track : point_tracks) {
    if (auto point = BuildPoint(camera, map.views, track)) {
      map.points.push_back(std::move(*point));
    }
  }
  if (map.points.empty()) return map;
  const DepthRange depths = LineDepths(map);
  for (const FeatureTrack& track : line_tracks) {
    if (auto line = BuildLine(camera, map.views, track, depths)) {
      map.lines.push_back(std::move(*line));
    }
  }
  return map;
}

double MedianDepth(const InitialMap& map) {
  std::vector<double> depths;
  for (const InitialPoint& point : map.points) {
    depths.push_back((map.views.front().cam_from_world * point.position).z());
  }
  return UpperMedian(std::move(depths));
}

void ScaleToMedianDepth(InitialMap& map) {
  const double depth = MedianDepth(map);
  if (!(depth > 0)) return;
  const double factor = 1 / depth;
  for (InitialView& view : map.views) view.cam_from_world.translation *= factor;
  for (InitialPoint& point : map.points) point.position *= factor;
  for (InitialLine& line : map.lines) {
    line.line.moment *= factor;
    line.segment.start *= factor;
    line.segment.end *= factor;
  }
}

void AdjustMap(const RectifiedCamera& camera, InitialMap& map) {
  const BaProblem problem = MakeProblem(camera, map);
  // The solution is iterated to the end, because the map is accepted by the accuracy of this
  // solution.
  LocalBaOptions options;
  options.max_iterations = 30;
  options.function_tolerance = 1e-6;
  const BaResult result = SolveLocalBa(problem, options);
  TakeOver(camera, result, map);
  ScaleToMedianDepth(map);
}

}  // namespace plumbline
