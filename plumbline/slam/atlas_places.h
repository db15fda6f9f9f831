// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/place_index.h"
#include "plumbline/map/atlas.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns the map with a keyframe; nullptr if no map has it, or has it any more.
const Map* MapOf(const Atlas& atlas, KeyFrameId id);

// Brings an index up to date: afterwards it has exactly the keyframes of the maps of the atlas, and
// answers like an index built anew, for instance in a run that continues a saved map. Cost: that of
// adding and removing the changed keyframes, and one comparison of bits in each map for every 64
// keyframe ids.
void Follow(const Atlas& atlas, PlaceIndex* index);

// Returns the keyframes of a map most similar in appearance to an image, the most similar first.
std::vector<KeyFrameId> MostAlike(const PlaceIndex& index,
                                  const Map& map,
                                  const Features& features,
                                  std::size_t most);

}  // namespace plumbline
