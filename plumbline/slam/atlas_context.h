// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/options.h"

#include <string>

namespace plumbline {

class System;

// The options as YAML, without what changes no result: inline is written as lockstep, and features
// in one thread as in two.
std::string ResultOptionsYaml(const SlamOptions& options);

// The id of the session that begins with this frame.
Uuid SessionUuid(const System& system, const MeasuredFrame& first);

// What the system's maps were made with, for SaveAtlas. After System::Finish, or inline.
AtlasContext ContextOf(const System& system);

// The same in two steps, for a copy of the maps in the middle of a run: what the thread that tracks
// knows at any time, and what belongs to the maps.
AtlasContext ContextWithoutMaps(const System& system);
void AddMaps(const Atlas& atlas, const LocalMapper::State& mapper, AtlasContext& context);

}  // namespace plumbline
