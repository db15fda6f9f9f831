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

// Saved maps and what messages call them: the file, mostly.
struct NamedAtlas {
  std::string name;
  SavedAtlas saved;
};

struct MergedAtlases {
  SavedAtlas saved;               // its active map is the joined one
  Similarity3 first_from_second;  // of the worlds
  std::vector<LoopEdge> overlap;  // as of MergedMaps; empty where the transform was given
  int ties = 0;                   // as of MergedMaps
};

// Told a sentence about what makes the result worth less.
using Remark = std::function<void(const std::string&)>;

// Makes one map of the active maps of two atlases of the same camera, in the world of the first:
// joined as `transform` (first_from_second) says, or where they show the same places (MergeMaps,
// with the options that the first was made with). Throws InputError for atlases without maps, for
// other cameras, for a scale of maps of measured depth, and for maps that cannot be merged for
// certain.
MergedAtlases MergeAtlases(NamedAtlas first,
                           const NamedAtlas& second,
                           const std::optional<Similarity3>& transform,
                           const Remark& remark);

}  // namespace plumbline
