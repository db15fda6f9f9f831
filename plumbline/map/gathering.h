// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/saved_atlas.h"

namespace plumbline {

// The maps of two saved atlases in one.
struct GatheredAtlases {
  SavedAtlas saved;  // active is the first one's active map
  MapId second;      // the second one's active map; invalid where it has none
};

// Brings the maps of two atlases of the same camera together, side by side: those of the first as
// they are, those of the second with ids behind them (Renumbered). Sessions that both have, by
// their ids, are one. The evidence about the stereo pair adds up where it is of one rig and of
// different sessions, so that none counts twice; else it is that of the first, as camera, options
// and front end are. O(observations of the second).
GatheredAtlases Gather(SavedAtlas first, const SavedAtlas& second);

// After maps of the atlas were joined: what was kept beside the map that is gone goes to the one
// that took it in.
void SettleJoined(SavedAtlas& saved);

}  // namespace plumbline
