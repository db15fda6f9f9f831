// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/path.h"
#include "worlds/scene.h"
#include "worlds/synth_options.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace plumbline {

// A scene and the way of a camera through it; some have another one, for a second visit.
struct World {
  Scene scene;
  CameraPath path;
  std::optional<CameraPath> second_path = {};
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

}  // namespace plumbline
