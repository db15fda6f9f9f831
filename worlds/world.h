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

// A scene and the path of a camera through it; some have a second path, for a second visit.
struct World {
  Scene scene;
  CameraPath path;
  std::optional<CameraPath> second_path = {};
};

// A built-in world or that of a file.
struct WorldSource {
  std::string name;
  std::string help;       // one line: its contents
  std::string purpose;    // one line: its purpose; empty for files
  SynthOptions defaults;  // default options of its recording
  std::function<World(std::uint64_t seed)> make;
  std::string text;  // of its file; empty for built-in worlds
};

}  // namespace plumbline
