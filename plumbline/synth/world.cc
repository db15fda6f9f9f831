// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/world.h"

#include "plumbline/base/error.h"
#include "plumbline/synth/worlds/worlds.h"

#include <array>
#include <string>

namespace plumbline {
namespace {

constexpr std::array kWorlds = {
    WorldEntry{"room",
               "a workshop with shelves, tables, posters and a window; one loop by hand",
               "small and rich, for demonstrations and tests",
               nullptr,
               MakeRoom},
    WorldEntry{"lowtexture",
               "blank rooms along a corridor, suspended ceilings; a cart drives through them",
               "few points, many lines: the synthetic sequence of the second paper",
               nullptr,
               MakeLowTexture}};

}  // namespace

std::span<const WorldEntry> Worlds() { return kWorlds; }

const WorldEntry& FindWorld(std::string_view name) {
  std::string names;
  for (const WorldEntry& known : kWorlds) {
    if (name == known.name) return known;
    names += std::string(names.empty() ? "" : ", ") + known.name;
  }
  throw InputError("world: expected one of " + names + ", found " + std::string(name));
}

}  // namespace plumbline
