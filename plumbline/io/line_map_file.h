// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <filesystem>
#include <vector>

namespace plumbline {

// Returns the lines of a file in the scale and world of that file: of an .obj its segments
// (ReadObjLines), as written by a run at its end; of a .plb the line landmarks of its active map,
// each between its ends. Throws InputError if the name has another extension, and like ReadObjLines
// and LoadMap.
std::vector<Segment3> ReadLineMap(const std::filesystem::path& path);

}  // namespace plumbline
