// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <filesystem>
#include <span>

namespace plumbline {

// Writes line segments as an ASCII DXF file of AutoCAD release 12 (AC1009), which every CAD program
// reads: LINE entities on the layer PLUMBLINE_LINES. Coordinates as given (metres), 6 decimals; the
// extent of the drawing in the header. The same input gives the same bytes. Throws InputError if
// the file cannot be written.
void WriteDxfLines(const std::filesystem::path& path, std::span<const Segment3> segments);

}  // namespace plumbline
