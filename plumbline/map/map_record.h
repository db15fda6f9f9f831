// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/feature_correction.h"
#include "plumbline/map/removed_keyframes.h"

#include <cstdint>
#include <map>

namespace plumbline {

// All of a map except its keyframes and landmarks. MapBuilder restores the map from both.
struct MapRecord {
  MapId id{0};
  std::int64_t version = 0;
  std::int64_t keyframes_taken_in = 0;
  KeyFrameId next_keyframe{0};
  PointId next_point{0};
  LineId next_line{0};
  FeatureCorrection correction;
  std::map<KeyFrameId, RemovedKeyFrame> removed_keyframes;
  // key: the removed landmark; value: the one it was merged into
  std::map<PointId, PointId> merged_points;
  std::map<LineId, LineId> merged_lines;
};

}  // namespace plumbline
