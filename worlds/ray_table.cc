// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/ray_table.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <optional>

namespace plumbline {
namespace {

constexpr double kPlaneCosine = 0.17364817766693;  // of 80 degrees

}  // namespace

RayTable::RayTable(const Camera& camera) : width_(camera.width()), height_(camera.height()) {
  const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  // One ray a pixel, and one beyond each border; the slope comes from the two neighbours.
  std::vector<std::optional<Eigen::Vector3d>> grid;
  const int stride = width_ + 2;
  grid.reserve(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height_ + 2));
  for (int y = -1; y <= height_; ++y) {
    for (int x = -1; x <= width_; ++x) {
      grid.push_back(camera.Ray({static_cast<double>(x), static_cast<double>(y)}));
      on_plane_ =
          on_plane_ && (!grid.back() || grid.back()->z() > kPlaneCosine * grid.back()->norm());
    }
  }
  for (std::optional<Eigen::Vector3d>& ray : grid) {
    if (ray) ray = Scaled(*ray);
  }
  entries_.reserve(count);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::optional<Eigen::Vector3d>* centre = grid.data() + (y + 1) * stride + x + 1;
      Entry& entry = entries_.emplace_back();
      if (!*centre) continue;
      entry.seen = true;
      entry.ray = (*centre)->cast<float>();
      // A neighbour without a ray is replaced by the pixel itself.
      const auto slope = [&](int step) -> Eigen::Vector3f {
        const Eigen::Vector3d& after = centre[step] ? *centre[step] : **centre;
        const Eigen::Vector3d& before = centre[-step] ? *centre[-step] : **centre;
        const double pixels = (centre[step] ? 1 : 0) + (centre[-step] ? 1 : 0);
        return ((after - before) / std::max(pixels, 1.0)).cast<float>();
      };
      entry.slope << slope(1), slope(stride);
    }
  }
  if (!at(width_ / 2, height_ / 2).seen) {
    throw InputError("camera: expected a ray for the pixel in the middle, found none");
  }
}

std::optional<Eigen::Vector3d> RayTable::Scaled(const Eigen::Vector3d& direction) const {
  if (!on_plane_) return direction.normalized();
  if (!(direction.z() > 0)) return std::nullopt;
  return Eigen::Vector3d(direction.x() / direction.z(), direction.y() / direction.z(), 1);
}

}  // namespace plumbline
