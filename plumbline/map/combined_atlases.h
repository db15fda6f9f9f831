// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/saved_atlas.h"

namespace plumbline {

// The maps of two saved atlases, combined in one atlas.
struct CombinedAtlases {
  SavedAtlas saved;  // its active map is that of the first atlas
  // Active map of the second atlas; invalid if it has none.
  MapId second;
};

// Combines the maps of two atlases of the same camera. Maps of the first keep their ids, those of
// the second get ids after them (Renumbered). Sessions with the same uuid become one. The evidence
// about the stereo pair is summed if it comes from one rig and different sessions, so that none
// counts twice; otherwise it is that of the first, as are camera, options and front end.
// O(observations of the second).
CombinedAtlases CombineAtlases(SavedAtlas first, const SavedAtlas& second);

// Hands the data kept beside each absorbed map to the map that absorbed it.
void SettleJoined(SavedAtlas& saved);

}  // namespace plumbline
