// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/options.h"

#include <map>
#include <string>

namespace plumbline {

// Returns the options as YAML, without choices that change no result: the mode inline is written as
// lockstep, and features measured in one thread as in two.
std::string ResultOptionsYaml(const SlamOptions& options);

// Adds to the context of a system what belongs to its maps: their ids, their young landmarks, and
// what is known of the stereo pair.
void AddMaps(const Atlas& atlas, const LocalMapper::State& mapper, AtlasContext& context);

// Returns the young landmarks of each map, as AddMaps wrote them into the context.
std::map<MapId, RecentLandmarks> YoungOf(const AtlasContext& context);

}  // namespace plumbline
