// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/colmap_folder.h"

#include "plumbline/io/atomic_file.h"
#include "plumbline/io/limap_lines.h"

namespace plumbline {

void WriteColmapFolder(const std::filesystem::path& folder,
                       const Map& map,
                       const ColmapModel& model,
                       const std::map<KeyFrameId, std::string>& names,
                       ColmapFiles files) {
  const std::filesystem::path sparse = folder / "sparse" / "0";
  MakeFolder(sparse);
  if (files != ColmapFiles::kBinary) WriteColmapText(sparse, model);
  if (files != ColmapFiles::kText) WriteColmapBinary(sparse, model);
  MakeFolder(folder / "lines");
  WriteLimapLines(folder / "lines", map, names);
}

}  // namespace plumbline
