// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/line_map_file.h"

#include "plumbline/base/error.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/obj_lines.h"

namespace plumbline {

std::vector<Segment3> ReadLineMap(const std::filesystem::path& path) {
  if (path.extension() == ".obj") return ReadObjLines(path);
  if (path.extension() != ".plb") {
    throw InputError(path.string() + ": expected a file name ending in .obj or .plb");
  }
  std::vector<Segment3> segments;
  const SavedMap saved = LoadMap(path);
  for (const auto& [id, line] : saved.map.lines()) segments.push_back(line.Interval());
  return segments;
}

}  // namespace plumbline
