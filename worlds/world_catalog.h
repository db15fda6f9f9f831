// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/world.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace plumbline {

// A built-in world that can be rendered as a recorded sequence.
struct WorldEntry {
  const char* name;
  const char* help;                   // one line: its contents, and the motion of the camera
  const char* purpose;                // one line: its purpose
  void (*adjust)(SynthOptions&);      // sets its own defaults; may be null
  World (*make)(std::uint64_t seed);  // everything in it is a function of the seed
};

// The built-in worlds, in the order shown to users.
std::span<const WorldEntry> Worlds();

// Returns the world of this name. Throws InputError for an unknown one, with all names.
const WorldEntry& FindWorld(std::string_view name);

// Returns a built-in world by its name, or that of a file whose name ends with .yaml
// (world_file.h). Throws InputError for an unknown name and for a file that describes no world.
WorldSource OpenWorld(std::string_view name_or_file);

}  // namespace plumbline
