// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/map_file/map_io.h"

#include "tests/map/map_fixture.h"
#include <cstdint>
#include <filesystem>

namespace plumbline {

// Saves a map of two keyframes, 50 ms apart from second 1 on, and a line that both see, with these
// ends.
inline void WriteLineLandmark(const std::filesystem::path& path,
                              const Segment3& ends,
                              const RectifiedCamera& camera = {50, 50, 32, 24, 0.1, 64, 48}) {
  Map map;
  for (std::int64_t id = 0; id < 2; ++id) {
    KeyFrame keyframe = BlankKeyFrame(id, id - 1);
    keyframe.frame.stamp_ns = 1'000'000'000 + 50'000'000 * id;
    map.Apply({edit::AddKeyFrame{keyframe}});
  }
  MapLine line = LineSeenBy(0, {{KeyFrameId{0}, 0}, {KeyFrameId{1}, 0}});
  line.created_by = KeyFrameId{0};
  line.line = LineThroughPoints(ends.start, ends.end);
  line.start = line.line.ParameterOf(ends.start);
  line.end = line.line.ParameterOf(ends.end);
  map.Apply({edit::AddLine{line}});
  SaveMap(path, camera, Eigen::Quaterniond::Identity(), map);
}

}  // namespace plumbline
