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
  const char* help;                   // one line: what is in it, how the camera moves
  const char* purpose;                // one line: what it is for
  void (*adjust)(SynthOptions&);      // its own defaults; may be null
  World (*make)(std::uint64_t seed);  // everything in it is a function of the seed
};

// The built-in worlds, in the order shown to users.
std::span<const WorldEntry> Worlds();

// The world of that name. Throws InputError for an unknown one, with the names there are.
const WorldEntry& FindWorld(std::string_view name);

// A built-in world by its name, or that of a file whose name ends with .yaml (world_file.h). Throws
// InputError for an unknown name and for a file that describes no world.
WorldSource OpenWorld(std::string_view name_or_file);

}  // namespace plumbline
