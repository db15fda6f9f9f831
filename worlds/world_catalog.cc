// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/world_catalog.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "worlds/built_in/worlds.h"
#include "worlds/world_file.h"

#include <array>
#include <string>

namespace plumbline {
namespace {

void FollowTheLight(SynthOptions& options) { options.auto_exposure = true; }

void DriveACar(SynthOptions& options) {
  options.camera = SynthCamera::kKitti;
  options.rate_hz = 10;
  options.baseline = 0.537;
  options.distortion = false;
  options.exposure = 1.7;
  options.vignetting = 0.05;
  options.finest_texel = 0.012;  // no ground is seen from closer than 6 m
}

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
               MakeLowTexture},
    WorldEntry{"vicon_easy",
               "a hall for motion capture: mats, drums, boards, curtains; a slow flight",
               "a flying vehicle that moves gently",
               [](SynthOptions& options) { options.shutter_ms = 8; },
               MakeViconEasy},
    WorldEntry{"vicon_medium",
               "the same hall; a flight at 1 m/s",
               "a flying vehicle at its usual pace, a little motion blur",
               [](SynthOptions& options) { options.shutter_ms = 12; },
               MakeViconMedium},
    WorldEntry{"vicon_difficult",
               "the same hall; a flight at 1.8 m/s with fast turns",
               "an agile vehicle, strong motion blur",
               [](SynthOptions& options) { options.shutter_ms = 16; },
               MakeViconDifficult},
    WorldEntry{"office",
               "an open office, meeting room, kitchen and corridor; a long walk through all",
               "a furnished building with daylight, many loops and revisits",
               nullptr,
               MakeOffice},
    WorldEntry{"loop",
               "four rooms and four corridors in a ring, walked round twice",
               "closing loops: 134 m, each place seen again a round later",
               nullptr,
               MakeLoop},
    WorldEntry{
        "floors",
        "two storeys that look alike and a staircase; both walked round, the lower one twice",
        "loops that must not be closed: what looks the same is 3 m above",
        nullptr,
        MakeFloors},
    WorldEntry{"planar",
               "a picture as large as a wall and nothing else; by hand, sideways and up and down",
               "initialization when all points lie in one plane",
               nullptr,
               MakePlanar},
    WorldEntry{"forward",
               "a street of shops under a roof; a cart rolling straight ahead",
               "initialization with low parallax",
               nullptr,
               MakeForward},
    WorldEntry{"lateral",
               "a wall with niches, shelves and pipes; a cart rolling sideways along it, and back",
               "initialization and mapping with much parallax",
               nullptr,
               MakeLateral},
    WorldEntry{"rotation",
               "a study; a camera that turns about its centre on a tripod, then is walked by hand",
               "initialization after pure rotation",
               nullptr,
               MakeRotation},
    WorldEntry{"static",
               "a study; a camera on a tripod that gives by millimetres",
               "initialization without motion",
               nullptr,
               MakeStatic},
    WorldEntry{"lights",
               "an office by day whose lamps are switched on and off; by hand, automatic exposure",
               "changes of light",
               FollowTheLight,
               MakeLights},
    WorldEntry{"dynamic",
               "a hall with a luggage belt, people walking, fans and a swinging door; by hand",
               "things that move by themselves",
               nullptr,
               MakeDynamic},
    WorldEntry{"wires",
               "blinds, railings, fences, cables, slats; by hand around a room",
               "lines that are parallel, close and alike",
               nullptr,
               MakeWires},
    WorldEntry{"degenerate",
               "a bare hall with long level rails, pipes and boards; a cart rolling along them",
               "lines in the epipolar planes, which have no depth",
               nullptr,
               MakeDegenerate},
    WorldEntry{"town",
               "streets of houses with trees, parked cars and traffic; a car at 10 m/s",
               "driving: large image motion, landmarks of a second's life, revisits, loops",
               DriveACar,
               MakeTown}};

}  // namespace

std::span<const WorldEntry> Worlds() { return kWorlds; }

const WorldEntry& FindWorld(std::string_view name) {
  if (name == "vicon") name = "vicon_medium";
  std::string names;
  for (const WorldEntry& known : kWorlds) {
    if (name == known.name) return known;
    names += std::string(names.empty() ? "" : ", ") + known.name;
  }
  throw InputError("world: expected one of " + names + " or a file FILE.yaml, found " +
                   Printable(name));
}

WorldSource OpenWorld(std::string_view name_or_file) {
  if (name_or_file.ends_with(".yaml")) return ReadWorldFile(std::string(name_or_file));
  const WorldEntry& entry = FindWorld(name_or_file);
  WorldSource source{entry.name, entry.help, entry.purpose, {}, entry.make, ""};
  if (entry.adjust != nullptr) entry.adjust(source.defaults);
  return source;
}

}  // namespace plumbline
