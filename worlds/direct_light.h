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

// A grid of points from corner to corner of a surface, a little off it and its rim, which other
// bodies touch.
class SurfaceGrid {
 public:
  // cell: size of the grid's cells, metres, at most.
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

// The light that the lamps throw on a surface past all that stands still, at the points of its
// grid; a grid of values for each source.
//
// How: lamp by lamp, at every fourth point of the grid; where these do not lie on a line, as at the
// borders of shadows, at each point, elsewhere linear in between.
//   sources  of each lamp, in [0, source_count)
std::vector<Image<float>> DirectLight(const SurfaceGrid& grid,
                                      std::span<const Lamp> lamps,
                                      std::span<const int> sources,
                                      int source_count,
                                      const RayTracer& tracer);

}  // namespace plumbline
