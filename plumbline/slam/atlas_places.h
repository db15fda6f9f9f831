// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"
#include "plumbline/place/place_index.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns the map that has a keyframe; nullptr where no map has it or has it any more.
const Map* MapOf(const Atlas& atlas, KeyFrameId id);

// Brings an index up to date: afterwards it holds exactly the keyframes that the maps of the atlas
// hold. It then answers like an index that is built anew, for instance by a run that goes on from a
// saved map. Cost: that of adding and removing what has changed, and one comparison of bits in each
// map for every 64 ids of keyframes.
void Follow(const Atlas& atlas, PlaceIndex* index);

// Returns the keyframes of a map that show what an image shows, the most alike first.
std::vector<KeyFrameId> MostAlike(const PlaceIndex& index,
                                  const Map& map,
                                  const Features& features,
                                  std::size_t most);

}  // namespace plumbline
