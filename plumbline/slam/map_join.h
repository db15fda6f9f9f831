// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/atlas.h"

namespace plumbline {

// Two merged maps: the remaining map and the map merged into it.
struct JoinedMaps {
  MapId kept;
  MapId gone;
};

// Merges the two maps that an edge connects. The newer map, moved by the edge, becomes part of the
// older one, which becomes the active map. No landmarks are fused. Throws BugError if the edge does
// not connect two maps.
JoinedMaps JoinMaps(const LoopEdge& edge, Atlas& atlas);

}  // namespace plumbline
