// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

namespace plumbline {

// First bytes of map files. Their line ends reveal a transfer as text.
inline constexpr std::string_view kMapMagic = "PLBMAP\r\n";

// Writes an atlas with the complete state of a run, so that it can continue as if uninterrupted,
// and with the description of its origin (docs/adr/0009-map-file-format.md). Nothing is rounded,
// and the same atlas gives the same bytes. `active` is the map to continue, by default the active
// one.
//
// The file is replaced as a whole, once everything is on the disk, so that there is always a
// complete one. Throws InputError "cannot write <path>: <reason>" (no folder, no room). Memory:
// some megabytes. Time: a millisecond a keyframe.
void SaveAtlas(const std::filesystem::path& path,
               const Atlas& atlas,
               const AtlasContext& context,
               MapId active = MapId{});

// Reads a file of SaveAtlas; saved again, the atlas gives the same bytes. Throws InputError naming
// the file if it is missing, not a map, of another version, truncated, damaged (checksums) or
// inconsistent: for any bytes, the result is valid for all functions of Map. Time: half a
// millisecond a keyframe.
SavedAtlas LoadAtlas(const std::filesystem::path& path);

// A map with the camera of its features.
struct SavedMap {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  Map map;
  std::uint32_t version = 0;  // version of the file's format
  // Scale between octaves of the points' image pyramid; nullopt if the descriptors may differ from
  // those of the present front end (kFeatureFormat), so that images cannot be compared.
  std::optional<double> octave_scale = std::nullopt;
};

// Returns a map of an atlas with its part of the context.
SavedMap SavedMapOf(Map map, const AtlasContext& context, std::uint32_t file_version);

// Saves one map like SaveAtlas, without any other context.
void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map);

// Loads the active map of a file like LoadAtlas; an empty map if the file has none.
SavedMap LoadMap(const std::filesystem::path& path);

}  // namespace plumbline
