// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <filesystem>
#include <vector>

namespace plumbline {

// Returns the lines of a file in the unit and world of that file: of an .obj its segments
// (ReadObjLines), as a run makes them of its keyframes when it ends; of a .plb the line landmarks
// of its active map, each between the ends that it has there. Throws InputError where the name has
// another ending, and as ReadObjLines and LoadMap do.
std::vector<Segment3> ReadLineMap(const std::filesystem::path& path);

}  // namespace plumbline
