// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop/loop_edge.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

namespace plumbline {

// Unties what a loop tied: the counterpart of CloseLoop, for a loop that proved wrong. Landmarks
// that keyframes around its candidate and keyframes around its query show, and that nobody saw
// during at least half of the keyframes between the two, are two again: observations of the later
// half go to a new landmark in the same place, of which both look anew. It does not matter by whom
// they were made one: when the loop was closed, when duplicates around it were fused, or by frames
// that were tracked against both since.
//
// Keyframes stay where they are: what odometry said is kept in the images only, and the adjustment
// of the whole map, which is the caller's, brings it out again once the ties are gone. Landmarks
// that another loop ties between the same surroundings come apart, too, and are found again as
// those of any place are.
//
// Nothing where a keyframe of the loop has left the map without an ancestor. O(matches of the
// keyframes around the query).
MapEdit OpenLoop(const Map& map, const LoopEdge& loop);

}  // namespace plumbline
