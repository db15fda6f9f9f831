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

// A grid of points from corner to corner of a surface, slightly off it and inside its rim, because
// other bodies touch both.
class SurfaceGrid {
 public:
  // cell: largest size of the grid's cells, metres.
  SurfaceGrid(const Surface& surface, double cell);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Eigen::Vector3d& normal() const { return normal_; }
  Eigen::Vector3d At(int x, int y) const;

 private:
  const Surface& surface_;
  Eigen::Vector3d normal_;
  int columns_, rows_;
  double margin_a_, margin_b_;  // shares of the sides
};

// Returns the light of the lamps on a surface, shadowed by static objects, at the points of its
// grid; a grid of values for each source.
//
// Method: lamp by lamp, at every fourth point of the grid; where these are not linear, for example
// at the borders of shadows, at each point, elsewhere by linear interpolation.
//   sources  of each lamp, in [0, source_count)
std::vector<Image<float>> DirectLight(const SurfaceGrid& grid,
                                      std::span<const Lamp> lamps,
                                      std::span<const int> sources,
                                      int source_count,
                                      const RayTracer& tracer);

}  // namespace plumbline
