// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <filesystem>
#include <string_view>

#include <Eigen/Geometry>

namespace plumbline {

// What map files begin with; line ends show a transfer as text.
inline constexpr std::string_view kMapMagic = "PLBMAP\r\n";

// Writes an atlas with all that a run needs to go on with it as if it had never stopped, and with
// what tells what it was made of (docs/adr/0009-map-file-format.md). Nothing is rounded, and the
// same atlas gives the same bytes. `active` is the map to go on with, by default the active one.
//
// The file is replaced whole, once all of it is on the disk: whatever happens meanwhile, the last
// complete one is there. Throws InputError "cannot write <path>: <reason>" (no folder, no room).
// Memory: some megabytes. Time: a millisecond a keyframe.
void SaveAtlas(const std::filesystem::path& path,
               const Atlas& atlas,
               const AtlasContext& context,
               MapId active = MapId{});

// Reads such a file. Saved again, it has the same bytes. Throws InputError naming the file when it
// is missing, not a map, of a later version, cut short, damaged (checksums) or contradicts itself:
// whatever the bytes, what comes back serves all functions of Map. Time: half a millisecond a
// keyframe.
//
// A file of version 1 comes as an atlas of one map; it does not say everything (map_file_v1.h).
SavedAtlas LoadAtlas(const std::filesystem::path& path);

// A map with the camera that its features were measured with.
struct SavedMap {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  Map map;
  std::uint32_t version = 0;  // of the file's format
};

// SaveAtlas with one map, of which nothing else is known.
void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map);

// LoadAtlas for one map, the active one; an empty one where the file has none.
SavedMap LoadMap(const std::filesystem::path& path);

}  // namespace plumbline
