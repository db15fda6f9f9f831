// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/options.h"

#include <map>
#include <string>

namespace plumbline {

// Returns the options as YAML, without those that change no result: inline mode is written as
// lockstep, and feature extraction in one thread as in two.
std::string ResultOptionsYaml(const SlamOptions& options);

// Adds the map data of a system to its context: map ids, recent landmarks, and the calibration
// state of the stereo pair.
void AddMaps(const Atlas& atlas, const LocalMapper::State& mapper, AtlasContext& context);

// Returns the recent landmarks of each map from a context (AddMaps).
std::map<MapId, LandmarkIds> YoungOf(const AtlasContext& context);

}  // namespace plumbline
