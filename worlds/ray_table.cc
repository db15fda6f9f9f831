// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/ray_table.h"

#include "plumbline/base/error.h"

#include <optional>
#include <string>

namespace plumbline {

RayTable::RayTable(const Camera& camera) : width_(camera.width()), height_(camera.height()) {
  entries_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const auto ray_at = [&camera](double x, double y) -> Eigen::Vector2d {
    const std::optional<Eigen::Vector3d> ray = camera.Unproject({x, y});
    if (!ray) {
      throw InputError("camera: expected a ray for every pixel, found none at (" +
                       std::to_string(x) + ", " + std::to_string(y) + ")");
    }
    return ray->head<2>();
  };
  // One ray a pixel, and one beyond each border; the slope comes from the two neighbours.
  std::vector<Eigen::Vector2d> grid;
  const int stride = width_ + 2;
  grid.reserve(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height_ + 2));
  for (int y = -1; y <= height_; ++y) {
    for (int x = -1; x <= width_; ++x) grid.push_back(ray_at(x, y));
  }
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2d* centre = grid.data() + (y + 1) * stride + x + 1;
      Entry entry;
      entry.ray = centre->cast<float>();
      entry.slope.col(0) = (0.5 * (centre[1] - centre[-1])).cast<float>();
      entry.slope.col(1) = (0.5 * (centre[stride] - centre[-stride])).cast<float>();
      entries_.push_back(entry);
    }
  }
}

}  // namespace plumbline
