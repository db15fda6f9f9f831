// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/path.h"
#include "worlds/scene.h"
#include "worlds/synth_options.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// A scene and the way of a camera through it; some have another one, for a second visit.
struct World {
  Scene scene;
  CameraPath path;
  std::optional<CameraPath> second_path = {};
};

// A built-in world that can be rendered as a recorded sequence.
struct WorldEntry {
  const char* name;
  const char* help;                   // one line: what is in it, how the camera moves
  const char* purpose;                // one line: what it is for
  void (*adjust)(SynthOptions&);      // its own defaults; may be null
  World (*make)(std::uint64_t seed);  // everything in it is a function of the seed
};

// A world by whatever it is given: a built-in one or that of a file.
struct WorldSource {
  std::string name;
  std::string help;       // one line: what is in it
  std::string purpose;    // one line: what it is for; empty for files
  SynthOptions defaults;  // how it is recorded unless told otherwise
  std::function<World(std::uint64_t seed)> make;
  std::string text;  // of the file it comes from; empty for built-in worlds
};

// The built-in worlds, in the order shown to users.
std::span<const WorldEntry> Worlds();

// The world of that name. Throws InputError for an unknown one, with the names there are.
const WorldEntry& FindWorld(std::string_view name);

// A built-in world by its name, or that of a file whose name ends with .yaml (world_file.h). Throws
// InputError for an unknown name and for a file that describes no world.
WorldSource OpenWorld(std::string_view name_or_file);

}  // namespace plumbline
