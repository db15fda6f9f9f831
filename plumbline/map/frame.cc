// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/frame.h"

#include <utility>

namespace plumbline {
namespace {

std::vector<Eigen::Vector2d> PositionsOf(const Features& features) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(features.points.size());
  for (const PointFeature& point : features.points) positions.push_back(point.px);
  return positions;
}

}  // namespace

std::shared_ptr<const FrameFeatures> WithCorrection(
    const std::shared_ptr<const FrameFeatures>& indexed, const FeatureCorrection& correction) {
  if (indexed->correction == correction) return indexed;
  auto corrected = std::make_shared<FrameFeatures>(*indexed);
  Correct(indexed->correction, correction, corrected->features);
  if (!(indexed->correction.lens == correction.lens)) {
    corrected->point_grid = indexed->point_grid.WithPositions(PositionsOf(corrected->features));
  }
  corrected->correction = correction;
  return corrected;
}

std::shared_ptr<const FrameFeatures> WithRightLines(
    const std::shared_ptr<const FrameFeatures>& indexed, OptionalList<MeasuredSegment> measured) {
  if (measured.empty()) return indexed;
  auto whole = std::make_shared<FrameFeatures>(*indexed);
  Features lines;
  lines.line_right = std::move(measured);
  if (!(indexed->correction == FeatureCorrection())) Correct({}, indexed->correction, lines);
  whole->features.line_right = std::move(lines.line_right);
  return whole;
}

std::shared_ptr<const FrameFeatures> IndexFeatures(const RectifiedCamera& camera,
                                                   Features measured,
                                                   const FeatureCorrection& correction) {
  if (!(correction == FeatureCorrection())) Correct({}, correction, measured);
  PointGrid grid(PositionsOf(measured), camera.width, camera.height);
  return std::make_shared<const FrameFeatures>(
      FrameFeatures{std::move(measured), std::move(grid), correction});
}

Features MeasuredFeatures(const FrameFeatures& indexed) {
  Features measured = indexed.features;
  if (!(indexed.correction == FeatureCorrection())) Correct(indexed.correction, {}, measured);
  return measured;
}

}  // namespace plumbline
