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

// The first bytes of map files. Their line ends reveal a transfer as text.
inline constexpr std::string_view kMapMagic = "PLBMAP\r\n";

// Writes an atlas with all that a run needs to go on with it as if it had never stopped, and with
// the description of its origin (docs/adr/0009-map-file-format.md). Nothing is rounded, and the
// same atlas gives the same bytes. `active` is the map to go on with, by default the active one.
//
// The file is replaced whole, once everything is on the disk, so that there is always a complete
// one. Throws InputError "cannot write <path>: <reason>" (no folder, no room). Memory: some
// megabytes. Time: a millisecond a keyframe.
void SaveAtlas(const std::filesystem::path& path,
               const Atlas& atlas,
               const AtlasContext& context,
               MapId active = MapId{});

// Reads a file that SaveAtlas wrote; saved again, the atlas gives the same bytes. Throws InputError
// naming the file when it is missing, not a map, of another version, cut short, damaged (checksums)
// or contradicts itself: whatever the bytes, the result serves all functions of Map. Time: half a
// millisecond a keyframe.
SavedAtlas LoadAtlas(const std::filesystem::path& path);

// A map with the camera with which its features were measured.
struct SavedMap {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  Map map;
  std::uint32_t version = 0;  // version of the file's format
  // Scale between octaves of the points' image pyramid; nullopt where the descriptors are not known
  // to be those of the present front end (kFeatureFormat), so that images cannot be compared.
  std::optional<double> octave_scale = std::nullopt;
};

// Returns a map of an atlas with what of its context belongs to it.
SavedMap SavedMapOf(Map map, const AtlasContext& context, std::uint32_t file_version);

// Saves one map as SaveAtlas does, where nothing else is known of it.
void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map);

// Loads the active map of a file as LoadAtlas does; an empty map where the file has none.
SavedMap LoadMap(const std::filesystem::path& path);

}  // namespace plumbline
