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
  double min_contrast = 0.1;   // light of the lamp relative to all light beside the shadow
  double min_step = 0.03;      // light of the lamp times the tone of the surface; 1 is white
  double max_penumbra = 0.03;  // metres from full light to full shadow
  double min_throw = 0.02;     // metres from the edge to its shadow
  double min_length = 0.05;    // metres
};

// A straight border of a shadow on a still surface: the middle of the penumbra.
struct ShadowEdge {
  Segment3 segment;  // world, metres
  int circuit = 0;   // of the lamp
};

// Returns the straight borders of the shadows of static objects on static surfaces.
//
// For each lamp: `edges` (of bodies, world) on an outline as seen from the lamp's centre are
// projected from there on the planes of the surfaces that it lights, and clipped to them. Along the
// result, every centimetre, rays to the lamp's centre on both sides determine whether there is a
// border of light; the width of the penumbra is the angular size of the lamp from the edge, across
// the border, times the distance from edge to surface; the lamp's light is compared with that of
// all lamps, all on, and 30 % more for reflections. Chains become one edge. Curved or blurred
// borders are left out, and so are those adjacent to the object that casts them, since they appear
// as a part of its edge. Cost: 3 s on one core for 12 000 edges and 24 lamps; the result does not
// depend on `threads`.
std::vector<ShadowEdge> ShadowEdges(const Scene& scene,
                                    std::span<const Segment3> edges,
                                    const RayTracer& tracer,
                                    const ShadowLimits& limits,
                                    int threads);

}  // namespace plumbline
