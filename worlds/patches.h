// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Rows of text on a patch, half a line off its sides.
struct PatchText {
  double line = 0.02;  // from row to row, metres
  double ink = 0.1;    // reflectance of the letters
};

// A flat piece of one colour in a layout: a rectangle, or the ellipse inside it.
struct Patch {
  Eigen::AlignedBox2d box;
  double value = 0.5;
  bool ellipse = false;
  bool stain = false;  // true: multiplies the colour below by `value` instead of hiding it
  double shade = 0;    // strength of its own soft shading, like that of a photograph
  std::uint64_t seed = 0;
  std::optional<PatchText> text = std::nullopt;
};

// A box given by its corners, metres.
inline Eigen::AlignedBox2d BoxOf(double u0, double v0, double u1, double v1) {
  return {Eigen::Vector2d(u0, v0), Eigen::Vector2d(u1, v1)};
}

// Reflectance of patches on top of each other, the last on top, on a ground; edges are averaged
// over a cell.
double PaintPatches(const std::vector<Patch>& patches,
                    const Eigen::Vector2d& at,
                    double ground,
                    const Eigen::Vector2d& cell);

// Appends the sides of the rectangles not hidden by later patches, in pieces between the crossings
// with outlines of other patches.
void AppendPatchEdges(const std::vector<Patch>& patches, std::vector<Segment2>* edges);

}  // namespace plumbline
