// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"
#include "plumbline/place/place_index.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// The map that has a keyframe; nullptr where none has it (any more).
const Map* MapOf(const Atlas& atlas, KeyFrameId id);

// Brings an index up to date: afterwards it holds exactly the keyframes that the maps of the atlas
// hold. So it answers as an index that is made anew, for instance by a run that goes on from a
// saved map. Cost: that of adding what is new; and where keyframes have left, some tenths of a
// microsecond for each one there is.
void Follow(const Atlas& atlas, PlaceIndex* index);

// The keyframes of a map that show what an image shows, most alike first.
std::vector<KeyFrameId> MostAlike(const PlaceIndex& index,
                                  const Map& map,
                                  const Features& features,
                                  std::size_t most);

}  // namespace plumbline
