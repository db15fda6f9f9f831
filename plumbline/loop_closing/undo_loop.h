// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/map.h"

namespace plumbline {

// Undoes the fusions of a loop: the inverse of CloseLoop, for a loop that proved wrong. A landmark
// is split if keyframes around the candidate and keyframes around the query show it, and no
// keyframe showed it during at least half of the keyframes between the two. Observations of the
// later half go to a new landmark at the same position; the appearance of both is refreshed. It
// does not matter whether the landmark was fused when the loop was closed, with other duplicates
// around it, or by frames tracked against both parts since.
//
// Keyframes do not move. Odometry is stored only in the images; the caller must adjust the whole
// map, which restores it after the split. Landmarks that another loop connects between the same
// surroundings are split, too, and are found again like those of any place.
//
// Returns no changes if a keyframe of the loop has left the map without an ancestor. O(matches of
// the keyframes around the query).
MapEdit UndoLoop(const Map& map, const LoopEdge& loop);

}  // namespace plumbline
