// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"

#include <cstdint>
#include <filesystem>

#include <Eigen/Geometry>

namespace plumbline {

// A map with the camera that its features were measured with.
struct SavedMap {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
  Map map;
  std::uint32_t version = 0;  // of the file's format
};

// Writes keyframes with their features, points and lines (docs/adr/0009-map-file-format.md). All
// numbers are kept to the last bit, and the same map gives the same bytes. What serves the running
// program only is left out: the record of removed and merged objects. A keyframe whose parent was
// removed hangs on the newest older keyframe then. Throws InputError when the file cannot be
// written.
void SaveMap(const std::filesystem::path& path,
             const RectifiedCamera& camera,
             const Eigen::Quaterniond& rectified_from_left,
             const Map& map);

// Reads such a file. Throws InputError naming the file when it is missing, not a map, of another
// version, cut short, damaged (checksum) or contradicts itself.
SavedMap LoadMap(const std::filesystem::path& path);

}  // namespace plumbline
