// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <filesystem>
#include <vector>

namespace plumbline {

// Returns the line segments of a Wavefront OBJ file (as written by WriteObjLines of
// io/geometry_files.h), in the scale of the file: every pair of neighbours of an `l` record.
// Vertices are counted from 1, or from the end if negative, and must precede the record. Text after
// a '/' and all other records of OBJ are ignored. A segment may have no length. Malformed `v` and
// `l` records, and lines that are no record of OBJ, throw an InputError "path:line: expected ...,
// found ...".
std::vector<Segment3> ReadObjLines(const std::filesystem::path& path);

}  // namespace plumbline
