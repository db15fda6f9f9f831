// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

namespace plumbline {

// Unties what a loop tied: the counterpart of CloseLoop, for a loop that proved wrong. A landmark
// is split if keyframes around the candidate and keyframes around the query show it, and no
// keyframe showed it during at least half of the keyframes between the two. Observations of the
// later half go to a new landmark in the same place; the appearance of both is refreshed. It does
// not matter how the landmark became one: when the loop was closed, when duplicates around it were
// fused, or by frames that were tracked against both parts since.
//
// Keyframes stay where they are. Odometry is kept only in the images; the adjustment of the whole
// map, which the caller has to do, brings it out again once the ties are gone. Landmarks that
// another loop ties between the same surroundings are split, too, and are found again like those of
// any place.
//
// Returns no changes where a keyframe of the loop has left the map without an ancestor. O(matches
// of the keyframes around the query).
MapEdit UndoLoop(const Map& map, const LoopEdge& loop);

}  // namespace plumbline
