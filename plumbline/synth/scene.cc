// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/scene.h"

#include "plumbline/synth/noise.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace plumbline {

using Eigen::Vector3d;

double SceneBuilder::Random(double low, double high) {
  return low + (high - low) * UnitFromHash(HashCell(static_cast<std::int64_t>(++count_), 1, seed_));
}

TextureRecipe SceneBuilder::Recipe(Material material, double tone, double corner_shade) {
  return {material, tone, HashCell(static_cast<std::int64_t>(++count_), 2, seed_), corner_shade};
}

void SceneBuilder::AddBox(const BoxShape& shape, Material material, double tone, double glow) {
  const Vector3d x(std::cos(shape.yaw), std::sin(shape.yaw), 0);
  const Vector3d y(-x.y(), x.x(), 0);
  const Vector3d sx = shape.size.x() * x, sy = shape.size.y() * y;
  const Vector3d sz = shape.size.z() * Vector3d::UnitZ();
  const Vector3d corner = shape.base - 0.5 * sx - 0.5 * sy;
  // The sides turn so that every normal points outward.
  const auto face = [&](const Vector3d& origin, const Vector3d& u, const Vector3d& v) {
    AddFace({origin, u, v, Recipe(material, tone), glow});
  };
  face(corner, sx, sz);
  face(corner + sx, sy, sz);
  face(corner + sx + sy, -sx, sz);
  face(corner + sy, -sy, sz);
  face(corner + sz, sx, sy);
  face(corner + sy, sx, -sy);
  const std::array<Vector3d, 4> foot = {
      corner, Vector3d(corner + sx), Vector3d(corner + sx + sy), Vector3d(corner + sy)};
  for (std::size_t i = 0; i < foot.size(); ++i) {
    const Vector3d& a = foot[i];
    const Vector3d& b = foot[(i + 1) % foot.size()];
    scene_.edges.push_back({a, b});
    scene_.edges.push_back({a + sz, b + sz});
    scene_.edges.push_back({a, a + sz});
  }
}

void SceneBuilder::AddRoom(const Vector3d& size, Material wall, Material floor) {
  const Vector3d x = size.x() * Vector3d::UnitX(), y = size.y() * Vector3d::UnitY();
  const Vector3d z = size.z() * Vector3d::UnitZ();
  const Vector3d o = Vector3d::Zero();
  constexpr double kCorner = 0.5;
  AddFace({o, x, y, Recipe(floor, 0.5, kCorner)});
  AddFace({z, y, x, Recipe(Material::kTiles, 0.55, kCorner)});
  AddFace({x, -x, z, Recipe(wall, 0.5, kCorner)});
  AddFace({x + y, -y, z, Recipe(Material::kBrick, 0.4, kCorner)});
  AddFace({y, x, z, Recipe(wall, 0.45, kCorner)});
  AddFace({o, y, z, Recipe(wall, 0.55, kCorner)});
  const std::array<Vector3d, 4> foot = {o, x, Vector3d(x + y), y};
  for (std::size_t i = 0; i < foot.size(); ++i) {
    const Vector3d& a = foot[i];
    const Vector3d& b = foot[(i + 1) % foot.size()];
    scene_.edges.push_back({a, b});
    scene_.edges.push_back({a + z, b + z});
    scene_.edges.push_back({a, a + z});
  }
}

}  // namespace plumbline
