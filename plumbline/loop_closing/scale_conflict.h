// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/options.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <span>

namespace plumbline {

// The finding that a map of one camera has the same things in two sizes.
struct ScaleConflict {
  KeyFrameId older;
  double scale = 1;  // lengths around the older keyframe / the same lengths around the newest
};

// Looks for an older keyframe of a map of one camera, among `candidates`, that shows the same
// things as the newest keyframe (VerifyLoop) but at least twice as large or half as large in the
// map. The difference must be certain by five deviations of the measurement and of the drift of the
// scale along the keyframes between (DriftOptions::log_scale). All frames between may have been
// tracked: every keyframe agrees with the one before it, and still the unit of the map runs away.
// Landmarks that both keyframes show take no part, since the map has one size for them.
//
//   cost  VerifyLoop for each candidate: about 5 ms where it is refused
std::optional<ScaleConflict> FindScaleConflict(const Map& map,
                                               KeyFrameId newest,
                                               std::span<const KeyFrameId> candidates,
                                               const CameraAndPyramid& imaging,
                                               const LoopOptions& options);

}  // namespace plumbline
