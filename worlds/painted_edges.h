// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "worlds/material.h"

#include <vector>

namespace plumbline {

struct PaintedEdgeLimits {
  double min_length = 0.05;  // metres
  double min_step = 0.04;    // of the reflectance, mean along a piece of the layout
  double min_share = 0.1;    // the same relative to the mean of both sides
  // longest gap of an edge in metres, for example of a bed by a head joint
  double max_gap = 0.02;
};

// Returns the straight edges painted on a surface of this size, metres from its corner, in the
// order of the layout: joints of planks, tiles, bricks and form boards, rims and blocks of posters,
// windows of screens, tape and labels, borders.
//
// They come from the layout of the reflectance, and are kept if the reflectance really changes: for
// each piece of the layout both sides are averaged over samples 0.7 to 2.2 mm off the edge. Both
// sides of a joint are edges, since each is a step; from far away they appear as one dark line a
// few millimetres wide. Successive pieces with a step, of either sign, become one edge. Letters,
// nails and similar marks are no lines. Edges closer than 3 mm to the rim of the surface are left
// to its geometry. Cost: about 3 us a piece.
std::vector<Segment2> PaintedEdges(const TextureRecipe& recipe,
                                   double width,
                                   double height,
                                   const PaintedEdgeLimits& limits = {});

}  // namespace plumbline
