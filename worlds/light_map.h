// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "worlds/ray_tracer.h"
#include "worlds/scene.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The light on the static surfaces of a scene: from its lamps, with soft shadows of static objects,
// and from surface to surface. Computed once, since it is constant; switched lamps are separate,
// and combined for each image.
//
// Method: on a grid on each surface, lamp by lamp, 32 rays to a rectangular one (5 if they agree);
// away from the borders of sharp shadows every fourth point of the grid suffices. Then, on a grid
// 25 times as coarse, two rounds of gathering the light reflected by the surrounding surfaces (64
// rays into the half space, each surface at its mean tone). Linear between grid points. Cost: some
// 2 us for each lamp and grid point in half shadow, 30 us for each point of the coarse grid.
class LightMaps {
 public:
  // A part of the light that is switched as a whole.
  struct Layer {
    int source = 0;     // 0: the sky and circuit 0; otherwise see LampOf and Levels
    Image<float> grid;  // values from corner to corner of the surface; 1 is white
  };

  // `cells` are the sizes of the grids' cells, metres, one for each surface. Scenes with moving
  // bodies keep each lamp separate, since bodies may occlude them individually.
  LightMaps(const Scene& scene,
            const RayTracer& tracer,
            std::span<const double> cells,
            int threads);

  // Returns the brightness of each source at a time; index: Layer::source.
  std::vector<float> Levels(double time) const;

  const std::vector<Layer>& LayersOf(unsigned surface) const { return layers_[surface]; }

  // Returns the lamp of a source of its own; null for shared sources.
  const Lamp* LampOf(int source) const;

  // Linear between the grid points; a, b in [0, 1].
  static float Sample(const Image<float>& grid, float a, float b);

 private:
  std::vector<Layer> BakeDirect(unsigned surface, const RayTracer& tracer, double cell) const;
  std::vector<Layer> Gather(unsigned surface,
                            const RayTracer& tracer,
                            double cell,
                            const std::vector<std::vector<Layer>>& light) const;
  int SourceOf(std::size_t lamp) const;
  int source_count() const;

  Scene scene_;
  bool lamps_apart_;
  std::vector<std::vector<Layer>> layers_;
};

}  // namespace plumbline
