// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/colmap_model.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {

// File formats of a COLMAP model.
enum class ColmapFiles { kText, kBinary, kBoth };
constexpr auto EnumNames(std::type_identity<ColmapFiles>) {
  return std::array{std::pair{ColmapFiles::kText, "text"},
                    std::pair{ColmapFiles::kBinary, "binary"},
                    std::pair{ColmapFiles::kBoth, "both"}};
}

// Writes a map for COLMAP and LIMAP into an existing folder: sparse/0/ with the model in the
// formats `files`, and lines/ with the lines (WriteLimapLines). Images are not written. Throws
// InputError if a folder or file cannot be written.
void WriteColmapFolder(const std::filesystem::path& folder,
                       const Map& map,
                       const ColmapModel& model,
                       const std::map<KeyFrameId, std::string>& names,
                       ColmapFiles files = ColmapFiles::kBoth);

}  // namespace plumbline
