// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/association/fusion.h"

#include "plumbline/association/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

ProjectionSearchOptions SearchOptions(const FusionOptions& options) {
  ProjectionSearchOptions search;
  search.point_radius_px = options.point_radius_px;
  search.point_max_distance = options.point_max_distance;
  search.point_ratio = 1;
  search.line_offset_px = options.line_offset_px;
  search.line_angle_deg = options.line_angle_deg;
  search.line_max_distance = options.line_max_distance;
  return search;
}

bool PointAgrees(const RectifiedCamera& camera,
                 const Frame& frame,
                 std::size_t feature,
                 const MapPoint& point,
                 double max_chi2) {
  const auto residual = EvaluatePoint(
      camera, frame.cam_from_world, point.position, MeasurePoint(frame.features(), feature));
  return residual && residual->r.squaredNorm() <= max_chi2 * (residual->rows == 3 ? 1.3 : 1.0);
}

bool LineAgrees(const RectifiedCamera& camera,
                const Frame& frame,
                std::size_t feature,
                const MapLine& line,
                double max_chi2) {
  const auto agrees = [&](LineMeasurement measurement) {
    AddLandmarkUncertainty(camera,
                           frame.cam_from_world,
                           line.line,
                           line.information,
                           LineWeighting::kCovariance,
                           measurement);
    const auto residual =
        EvaluateLine(camera, frame.cam_from_world, ToOrthonormal(line.line), measurement);
    return residual && residual->r.squaredNorm() <= max_chi2;
  };
  const auto right = MeasureRightLine(frame.features(), feature, LineWeighting::kCovariance);
  return agrees(MeasureLeftLine(frame.features(), feature, LineWeighting::kCovariance)) &&
         (!right || agrees(*right));
}

// Landmarks of one kind that `from` shows and `to` does not.
template <class Landmark, class LandmarkId>
std::vector<const Landmark*> Missing(const Map& map,
                                     const std::vector<LandmarkId>& matches,
                                     KeyFrameId to) {
  std::vector<const Landmark*> missing;
  for (const LandmarkId id : matches) {
    const Landmark* landmark = id.valid() ? map.Find(id) : nullptr;
    if (landmark != nullptr && !landmark->observations.contains(to)) missing.push_back(landmark);
  }
  return missing;
}

template <class Merge, class Landmark>
Merge MergeInto(const Landmark& a, const Landmark& b) {
  const bool keep_a = a.observations.size() > b.observations.size() ||
                      (a.observations.size() == b.observations.size() && a.id < b.id);
  return keep_a ? Merge{a.id, b.id} : Merge{b.id, a.id};
}

}  // namespace

MapEdit FuseLandmarks(const Map& map,
                      const ImagingModel& imaging,
                      KeyFrameId from,
                      KeyFrameId to,
                      const FusionOptions& options) {
  const Frame& source = map.Find(from)->frame;
  const Frame& target = map.Find(to)->frame;
  const ProjectionSearchOptions search = SearchOptions(options);
  MapEdit edit;

  const auto points = Missing<MapPoint>(map, source.points, to);
  std::vector<std::optional<ProjectedPoint>> projected_points;
  projected_points.reserve(points.size());
  for (const MapPoint* point : points) {
    projected_points.push_back(ProjectPoint(imaging, target.cam_from_world, *point, search));
  }
  const std::vector<bool> no_point(target.points.size(), false);
  for (const auto& match :
       MatchProjectedPoints(*target.indexed, projected_points, no_point, search)) {
    const MapPoint& point = *points[static_cast<std::size_t>(match.landmark)];
    const auto feature = static_cast<std::size_t>(match.feature);
    if (!PointAgrees(imaging.camera, target, feature, point, options.max_chi2)) continue;
    const PointId present = target.points[feature];
    if (present.valid()) {
      edit.push_back(MergeInto<edit::MergePoints>(point, *map.Find(present)));
    } else {
      edit.push_back(edit::AddPointObservation{point.id, to, match.feature});
    }
  }

  const auto lines = Missing<MapLine>(map, source.lines, to);
  std::vector<std::optional<ProjectedLine>> projected_lines;
  projected_lines.reserve(lines.size());
  for (const MapLine* line : lines) {
    projected_lines.push_back(ProjectLine(imaging, target.cam_from_world, *line, search));
  }
  const std::vector<bool> no_line(target.lines.size(), false);
  for (const auto& match : MatchProjectedLines(*target.indexed, projected_lines, no_line, search)) {
    const MapLine& line = *lines[static_cast<std::size_t>(match.landmark)];
    const auto feature = static_cast<std::size_t>(match.feature);
    if (!LineAgrees(imaging.camera, target, feature, line, options.max_chi2)) continue;
    const LineId present = target.lines[feature];
    if (present.valid()) {
      edit.push_back(MergeInto<edit::MergeLines>(line, *map.Find(present)));
    } else {
      edit.push_back(edit::AddLineObservation{line.id, to, match.feature});
    }
  }
  return edit;
}

}  // namespace plumbline
