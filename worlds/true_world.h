// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/parallelogram.h"
#include "worlds/true_line.h"

#include <filesystem>
#include <span>
#include <vector>

namespace plumbline {

// The lines and surfaces of a known world, in files beside a rendered sequence (lines.csv,
// surfaces.csv): comma-separated rows under a header that starts with '#', metres, world of the
// ground truth.

// Rows x1,y1,z1,x2,y2,z2[,kind[,visible]]: kind geometry (the default), texture or shadow; visible
// the frames that see the line, as ascending ranges such as `0-17 25 30-44`, empty for none, not
// recorded without the column. All rows have the columns of the first. Throws InputError
// "path:line: expected ..., found ..." for anything else, coincident ends included.
std::vector<TrueLine> ReadTrueLines(const std::filesystem::path& path);

// Writes a file of lines with the column kind, and with visible if the lines have it recorded (all
// or none of them). Numbers are exact to the last bit; the same input gives the same bytes. Throws
// InputError if the file cannot be written.
void WriteTrueLines(const std::filesystem::path& path, std::span<const TrueLine> lines);

// Reads rows ox,oy,oz,ux,uy,uz,vx,vy,vz. Throws InputError "path:line: ..." like ReadTrueLines, and
// if the sides span no area.
std::vector<Parallelogram> ReadSurfaces(const std::filesystem::path& path);
// Writes surfaces, with the precision and the failures of WriteTrueLines.
void WriteSurfaces(const std::filesystem::path& path, std::span<const Parallelogram> surfaces);

}  // namespace plumbline
