// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/fusion.h"

#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>

namespace plumbline {
namespace {

// The limits are narrower than those of tracking, because the poses are adjusted ones, and a
// landmark that is merged by mistake is not taken apart again.
constexpr ProjectionSearchOptions kSearch{.point_radius_px = 3,
                                          .point_max_distance = 50,
                                          .point_ratio = 1,
                                          .line_offset_px = 4,
                                          .line_angle_deg = 4,
                                          .line_max_distance = 60};
// A feature with a larger chi2 of the reprojection shows another landmark: 95 % for two residuals.
constexpr double kMaxChi2 = 5.99;

bool PointAgrees(const RectifiedCamera& camera,
                 const Frame& frame,
                 std::size_t feature,
                 const MapPoint& point) {
  const auto residual = EvaluatePoint(
      camera, frame.cam_from_world, point.position, MeasurePoint(frame.features(), feature));
  return residual && residual->r.squaredNorm() <= kMaxChi2 * (residual->rows == 3 ? 1.3 : 1.0);
}

bool LineAgrees(const RectifiedCamera& camera,
                const Frame& frame,
                std::size_t feature,
                const MapLine& line) {
  const UncertainLine uncertain(line.line, line.information);
  const auto agrees = [&](LineMeasurement measurement) {
    AddLandmarkUncertainty(
        camera, frame.cam_from_world, uncertain, LineWeighting::kCovariance, measurement);
    const auto distances =
        LineDistances(camera, frame.cam_from_world, uncertain.prepared, measurement);
    return distances && distances->squaredNorm() <= kMaxChi2;
  };
  const auto right = MeasureRightLine(frame.features(), feature, LineWeighting::kCovariance);
  return agrees(MeasureLeftLine(frame.features(), feature, LineWeighting::kCovariance)) &&
         (!right || agrees(*right));
}

// Returns the landmarks of one kind that `from` shows and `to` does not.
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

FusionInto::FusionInto(const Map& map, const CameraAndPyramid& imaging, KeyFrameId to)
    : map_(map),
      imaging_(imaging),
      to_(to),
      target_(&map.Find(to)->frame),
      point_matcher_(*target_->indexed, kSearch),
      line_matcher_(*target_->indexed, kSearch),
      no_point_(target_->points.size(), false),
      no_line_(target_->lines.size(), false) {}

MapEdit FusionInto::Fuse(KeyFrameId from) {
  const Frame& source = map_.Find(from)->frame;
  target_ = &map_.Find(to_)->frame;
  MapEdit edit;
  FusePoints(source, edit);
  FuseLines(source, edit);
  return edit;
}

void FusionInto::FusePoints(const Frame& source, MapEdit& edit) {
  const auto points = Missing<MapPoint>(map_, source.points, to_);
  Choices choices;
  choices.reserve(points.size());
  for (const MapPoint* point : points) choices.push_back(Choose(*point));
  for (const auto& match : OneToOne(choices, target_->points.size())) {
    const MapPoint& point = *points[static_cast<std::size_t>(match.landmark)];
    const auto feature = static_cast<std::size_t>(match.feature);
    if (!PointAgrees(imaging_.camera, *target_, feature, point)) continue;
    const PointId present = target_->points[feature];
    if (present.valid()) {
      edit.push_back(MergeInto<edit::MergePoints>(point, *map_.Find(present)));
    } else {
      edit.push_back(edit::AddPointObservation{point.id, to_, match.feature});
    }
  }
}

void FusionInto::FuseLines(const Frame& source, MapEdit& edit) {
  const auto lines = Missing<MapLine>(map_, source.lines, to_);
  Choices choices;
  choices.reserve(lines.size());
  for (const MapLine* line : lines) choices.push_back(Choose(*line));
  for (const auto& match : OneToOne(choices, target_->lines.size())) {
    const MapLine& line = *lines[static_cast<std::size_t>(match.landmark)];
    const auto feature = static_cast<std::size_t>(match.feature);
    if (!LineAgrees(imaging_.camera, *target_, feature, line)) continue;
    const LineId present = target_->lines[feature];
    if (present.valid()) {
      edit.push_back(MergeInto<edit::MergeLines>(line, *map_.Find(present)));
    } else {
      edit.push_back(edit::AddLineObservation{line.id, to_, match.feature});
    }
  }
}

std::optional<ProjectionMatch> FusionInto::Choose(const MapPoint& point) {
  const auto [known, is_new] = chosen_by_point_.try_emplace(point.id);
  if (is_new) {
    const auto projected = ProjectPoint(imaging_, target_->cam_from_world, point);
    if (projected) known->second = point_matcher_.Match(*projected, no_point_);
  }
  return known->second;
}

std::optional<ProjectionMatch> FusionInto::Choose(const MapLine& line) {
  const auto [known, is_new] = chosen_by_line_.try_emplace(line.id);
  if (is_new) {
    const auto projected = ProjectLine(imaging_, target_->cam_from_world, line);
    if (projected) known->second = line_matcher_.Match(*projected, no_line_);
  }
  return known->second;
}

}  // namespace plumbline
