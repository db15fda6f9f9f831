// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <map>
#include <optional>

namespace plumbline {

// Returns the change that moves a map line. The interval follows from the observed segments, each
// trimmed to the new line. With four or more views the outermost ends are dropped, since one view's
// overlong segment should not lengthen the line for ever. The information follows from all
// observations. The direction keeps its sense.
//   poses  keyframe poses that differ from the map's
//   kept   the ends, where the line keeps its own: the interval reaches from one to the other
edit::MoveLine RefitInterval(const Map& map,
                             const CameraAndPyramid& imaging,
                             const std::map<KeyFrameId, Rigid3>& poses,
                             const MapLine& line,
                             const PluckerLine& moved,
                             const std::optional<Segment3>& kept = std::nullopt);

}  // namespace plumbline
