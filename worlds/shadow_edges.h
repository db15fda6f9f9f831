// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "worlds/ray_tracer.h"
#include "worlds/scene.h"

#include <span>
#include <vector>

namespace plumbline {

struct ShadowLimits {
  double min_contrast = 0.1;   // what the lamp gives, of all light beside the shadow
  double min_step = 0.03;      // what the lamp gives times the tone of the surface; 1 is white
  double max_penumbra = 0.03;  // metres from full light to full shadow
  double min_throw = 0.02;     // metres from the edge to where its shadow falls
  double min_length = 0.05;    // metres
};

// A straight border of a shadow on a still surface: the middle of the penumbra.
struct ShadowEdge {
  Segment3 segment;  // world, metres
  int circuit = 0;   // of the lamp
};

// The straight borders of the shadows that still things throw on still surfaces.
//
// For each lamp: `edges` (of bodies, world) that are an outline as the lamp's centre sees them are
// projected from there on the planes of the surfaces it shines on, and cut to them. Along what
// remains, every centimetre, rays to the lamp's centre on both sides tell whether there is a border
// of light; the penumbra is as wide as the lamp looks from the edge, across the border, times the
// way from edge to surface; the lamp's light is compared with that of all lamps, all on, and 30 %
// more for what surfaces throw back. Chains become one edge. Curved or blurred borders are none,
// nor are those that hug the thing that throws them, for they look like a part of its edge.
// Cost: 3 s on one core for 12 000 edges and 24 lamps; the result does not depend on `threads`.
std::vector<ShadowEdge> ShadowEdges(const Scene& scene,
                                    std::span<const Segment3> edges,
                                    const RayTracer& tracer,
                                    const ShadowLimits& limits,
                                    int threads);

}  // namespace plumbline
