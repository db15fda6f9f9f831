// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/options.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <span>

namespace plumbline {

// Evidence that a map of one camera shows the same place at two scales.
struct ScaleConflict {
  KeyFrameId older;
  double scale = 1;  // scale around the older keyframe / scale around the newest
};

// Searches `candidates` for an older keyframe of a map of one camera that shows the same place as
// the newest keyframe (VerifyLoop) but at least twice as large or half as large in the map. The
// difference must exceed five standard deviations of the measurement and of the drift of the scale
// along the keyframes between (DriftOptions::log_scale). All frames between may have been tracked:
// every keyframe is consistent with the one before it, and still the scale of the map drifts away.
// Landmarks of both keyframes are ignored, since the map has one size for them.
//
//   cost  VerifyLoop for each candidate: about 5 ms for a refused one
std::optional<ScaleConflict> FindScaleConflict(const Map& map,
                                               KeyFrameId newest,
                                               std::span<const KeyFrameId> candidates,
                                               const CameraAndPyramid& imaging,
                                               const LoopOptions& options);

}  // namespace plumbline
