// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/atlas.h"

namespace plumbline {

// Two maps of which one took the other in.
struct JoinedMaps {
  MapId kept;
  MapId gone;
};

// Makes one map of the two that an edge ties. The older map takes in the younger one, moved as the
// edge says, and becomes the active one. No landmarks are fused. Throws BugError where the edge
// does not tie two maps.
JoinedMaps JoinMaps(const LoopEdge& edge, Atlas& atlas);

}  // namespace plumbline
