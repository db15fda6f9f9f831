// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/map.h"

#include <map>

namespace plumbline {

// The change that gives a map line a new place: its interval from the observed segments (each
// trimmed to the new line; of four or more views the outermost ends are left out, since one view's
// overlong segment should not lengthen the line for ever), its information from all observations,
// and its direction kept.
//   poses  keyframe poses that differ from the map's
edit::MoveLine RefitInterval(const Map& map,
                             const ImagingModel& imaging,
                             const std::map<KeyFrameId, Rigid3>& poses,
                             const MapLine& line,
                             const PluckerLine& moved);

}  // namespace plumbline
