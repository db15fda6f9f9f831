// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/saved_atlas.h"

namespace plumbline {

// The maps of two saved atlases in one atlas.
struct CombinedAtlases {
  SavedAtlas saved;  // its active map is the first atlas's
  // Active map of the second atlas; invalid where it has none.
  MapId second;
};

// Puts the maps of two atlases of the same camera side by side. Maps of the first keep their ids,
// those of the second get ids behind them (Renumbered). A session that both have, by its id,
// becomes one. The evidence about the stereo pair is added up where it comes from one rig and from
// different sessions, so that none counts twice; otherwise it is that of the first, as are camera,
// options and front end. O(observations of the second).
CombinedAtlases CombineAtlases(SavedAtlas first, const SavedAtlas& second);

// Hands what was kept beside a map that was joined to the map that took it in.
void SettleJoined(SavedAtlas& saved);

}  // namespace plumbline
