// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop/loop_edge.h"
#include "plumbline/map/atlas.h"

namespace plumbline {

// Which of two maps took the other one in.
struct JoinedMaps {
  MapId kept;
  MapId gone;
};

// Makes one map of the two that an edge ties: the older takes the younger in, moved as the edge
// says, and is the active one. Nothing is fused. BugError where the edge is not of two maps.
JoinedMaps JoinBy(const LoopEdge& edge, Atlas& atlas);

}  // namespace plumbline
