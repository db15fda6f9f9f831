// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/image/color_image.h"

#include <filesystem>
#include <span>

#include <Eigen/Core>

namespace plumbline {

// Writes points and line segments as an ASCII PLY file: the points grey, then the two ends of each
// segment in orange, connected by an `edge` element. Coordinates in metres, 6 decimals. The same
// input gives the same bytes. `colors`, if not empty, has one colour for each point. Throws
// InputError if the file cannot be written.
void WritePly(const std::filesystem::path& path,
              std::span<const Eigen::Vector3d> points,
              std::span<const Segment3> segments,
              std::span<const Color> colors = {});

// Writes line segments as a Wavefront OBJ file of `l` elements. Coordinates and failures are those
// of WritePly.
void WriteObjLines(const std::filesystem::path& path, std::span<const Segment3> segments);

// Writes line segments as an ASCII DXF file of AutoCAD release 12 (AC1009), which every CAD program
// reads: LINE entities on the layer PLUMBLINE_LINES. Coordinates as given (metres), 6 decimals; the
// extent of the drawing in the header. The same input gives the same bytes. Throws InputError if
// the file cannot be written.
void WriteDxfLines(const std::filesystem::path& path, std::span<const Segment3> segments);

}  // namespace plumbline
