// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/loop/options.h"
#include "plumbline/map/map.h"

#include <optional>
#include <span>

namespace plumbline {

// A map of one camera that has the same things in two sizes.
struct ScaleConflict {
  KeyFrameId older;
  double scale = 1;  // lengths around the older keyframe / the same lengths around the newest
};

// Whether the newest keyframe of a map of one camera and an older one, some of those that look
// alike, show the same things (VerifyLoop), but twice as large or half as large in the map, or
// more, and certainly so: by five deviations of what is measured and of what the scale may have
// drifted along the keyframes between (DriftOptions::log_scale). Frames may all have been tracked
// meanwhile: every keyframe agrees with the one before it, and the unit of the map runs away. Of
// what both keyframes have in common the map knows one size; nothing is asked of it.
//
//   cost  VerifyLoop for each candidate: about 5 ms where it is refused
std::optional<ScaleConflict> FindScaleConflict(const Map& map,
                                               KeyFrameId newest,
                                               std::span<const KeyFrameId> candidates,
                                               const ImagingModel& imaging,
                                               const LoopOptions& options);

}  // namespace plumbline
