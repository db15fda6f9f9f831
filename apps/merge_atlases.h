// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/map_merge.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Saved maps and their name in messages, usually the file.
struct NamedAtlas {
  std::string name;
  SavedAtlas saved;
};

struct MergedAtlases {
  SavedAtlas saved;               // the merged map is the active one
  Similarity3 first_from_second;  // from world to world
  std::vector<LoopEdge> overlap;  // as in MergedMaps; empty if the transform was given
  int ties = 0;                   // as in MergedMaps
};

// Called with a sentence for each flaw of the result.
using Remark = std::function<void(const std::string&)>;

// Merges the active maps of two atlases of the same camera, in the world of the first: by
// `transform` (first_from_second), or by common places (MergeMaps, with the options of the first
// map). Throws InputError for atlases without maps, for other cameras, for a scale between maps of
// measured depth, and for maps that cannot be merged reliably.
MergedAtlases MergeAtlases(NamedAtlas first,
                           const NamedAtlas& second,
                           const std::optional<Similarity3>& transform,
                           const Remark& remark);

}  // namespace plumbline
