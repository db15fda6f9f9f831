// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_creation.h"
#include "plumbline/matching/landmark_from_frame.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// Points with a relative depth deviation up to this are made if a keyframe shows too few better
// ones. Worse ones constrain hardly more than their direction.
constexpr double kWorstDepthSigma = 0.3;

struct DepthPoint {
  std::size_t feature;
  double relative_sigma;
};

// Returns the features without landmark from which points are made, the best known depth first.
std::vector<DepthPoint> ChooseDepthPoints(const Frame& frame,
                                          const LandmarkCreationOptions& options) {
  const auto& disparities = frame.features().point_disparity;
  std::vector<DepthPoint> free;
  int present = 0;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (!disparities[i] || !(disparities[i]->px > 0)) continue;
    const double relative = disparities[i]->sigma_px / disparities[i]->px;
    if (frame.points[i].valid()) {
      ++present;
    } else if (relative <= kWorstDepthSigma) {
      free.push_back({i, relative});
    }
  }
  std::stable_sort(free.begin(), free.end(), [](const DepthPoint& a, const DepthPoint& b) {
    return a.relative_sigma < b.relative_sigma;
  });
  std::size_t count = 0;
  while (count < free.size() && (free[count].relative_sigma <= options.max_relative_depth_sigma ||
                                 present + static_cast<int>(count) < options.min_depth_points)) {
    ++count;
  }
  free.resize(count);
  return free;
}

}  // namespace

DepthLandmarks LandmarksFromDepth(const RectifiedCamera& camera,
                                  const Frame& frame,
                                  const LandmarkCreationOptions& options) {
  DepthLandmarks landmarks;
  for (const DepthPoint& point : ChooseDepthPoints(frame, options)) {
    const auto model = PointFromFrame(camera, frame, point.feature, kWorstDepthSigma);
    if (model) landmarks.points.emplace_back(point.feature, *model);
  }
  for (std::size_t i = 0; i < frame.lines.size(); ++i) {
    if (frame.lines[i].valid()) continue;
    const auto model = LineFromFrame(camera, frame, i, options.max_relative_line_depth_sigma);
    if (model) landmarks.lines.emplace_back(i, *model);
  }
  return landmarks;
}

MapEdit CreateFromDepth(const Map& map,
                        const CameraAndPyramid& imaging,
                        KeyFrameId id,
                        const LandmarkCreationOptions& options) {
  const DepthLandmarks landmarks = LandmarksFromDepth(imaging.camera, map.Find(id)->frame, options);
  MapEdit edit;
  PointId next_point = map.NextPointId();
  for (const auto& [feature, model] : landmarks.points) {
    edit.push_back(edit::AddPoint{{model, next_point, id, {{id, static_cast<int>(feature)}}, {}}});
    ++next_point.value;
  }
  LineId next_line = map.NextLineId();
  for (const auto& [feature, model] : landmarks.lines) {
    edit.push_back(edit::AddLine{{model, next_line, id, {{id, static_cast<int>(feature)}}, {}}});
    ++next_line.value;
  }
  return edit;
}

}  // namespace plumbline
