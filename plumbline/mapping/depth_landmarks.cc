// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/association/landmark_from_frame.h"
#include "plumbline/mapping/landmark_creation.h"

#include <cstddef>

namespace plumbline {

MapEdit CreateFromDepth(const Map& map,
                        const ImagingModel& imaging,
                        KeyFrameId id,
                        const LandmarkCreationOptions& options) {
  const Frame& frame = map.Find(id)->frame;
  const double max_sigma = options.max_relative_depth_sigma;
  MapEdit edit;
  PointId next_point = map.NextPointId();
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (frame.points[i].valid()) continue;
    const auto model = PointFromFrame(imaging.camera, frame, i, max_sigma);
    if (!model) continue;
    edit.push_back(edit::AddPoint{{*model, next_point, id, {{id, static_cast<int>(i)}}, {}}});
    ++next_point.value;
  }
  LineId next_line = map.NextLineId();
  for (std::size_t i = 0; i < frame.lines.size(); ++i) {
    if (frame.lines[i].valid()) continue;
    const auto model = LineFromFrame(imaging.camera, frame, i, max_sigma);
    if (!model) continue;
    edit.push_back(edit::AddLine{{*model, next_line, id, {{id, static_cast<int>(i)}}, {}}});
    ++next_line.value;
  }
  return edit;
}

}  // namespace plumbline
