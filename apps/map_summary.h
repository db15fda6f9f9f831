// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Geometry>

namespace plumbline {

// Statistics of a map. Lengths are in metres, for a single camera in map units.
struct MapSummary {
  std::size_t keyframes = 0, points = 0, lines = 0;
  std::size_t point_observations = 0, line_observations = 0;
  std::optional<std::pair<std::int64_t, std::int64_t>> time_ns;  // first and last keyframe
  double path_length = 0;  // along the keyframes of successive tracking
  // Bounding boxes of points and line ends: of all, and of the middle 90 % along each axis.
  Eigen::AlignedBox3d bounds, middle_bounds;
  std::optional<double> reprojection_px;  // mean over the points (MeanReprojectionError)
};

MapSummary Summarize(const RectifiedCamera& camera, const Map& map);

// The output of `plumbline map info`: as text, statistics of the active map and the number of
// others; as JSON all maps, the active one first. With `memory` also what all maps take in memory,
// by kind of data (MemoryOf).
std::string MapInfoTable(const std::filesystem::path& path,
                         const SavedAtlas& saved,
                         bool memory = false);
std::string MapInfoJson(const std::filesystem::path& path,
                        const SavedAtlas& saved,
                        bool memory = false);

}  // namespace plumbline
