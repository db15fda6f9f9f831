// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/path.h"
#include "worlds/scene.h"
#include "worlds/synth_options.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace plumbline {

// A scene and the way of a camera through it; some have another one, for a second visit.
struct World {
  Scene scene;
  CameraPath path;
  std::optional<CameraPath> second_path = {};
};

// A world that can be rendered as a recorded sequence.
struct WorldEntry {
  const char* name;
  const char* help;                   // one line: what is in it, how the camera moves
  const char* purpose;                // one line: what it is for
  void (*adjust)(SynthOptions&);      // its own defaults; may be null
  World (*make)(std::uint64_t seed);  // everything in it is a function of the seed
};

// The worlds there are, in the order shown to users.
std::span<const WorldEntry> Worlds();

// The world of that name. Throws InputError for an unknown one, with the names there are.
const WorldEntry& FindWorld(std::string_view name);

}  // namespace plumbline
