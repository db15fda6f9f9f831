// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/scene_builder.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "worlds/noise.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {

using Eigen::Vector3d;

double SceneBuilder::Random(double low, double high) {
  return low + (high - low) * UnitFromHash(HashCell(static_cast<std::int64_t>(++count_), 1, seed_));
}

TextureRecipe SceneBuilder::Recipe(Material material, double tone, double corner_shade) {
  TextureRecipe recipe;
  recipe.material = material;
  recipe.tone = tone;
  recipe.seed = HashCell(static_cast<std::int64_t>(++count_), 2, seed_);
  recipe.corner_shade = corner_shade;
  return recipe;
}

void SceneBuilder::AddFace(Surface surface) {
  surface.body = body_;
  scene_.surfaces.push_back(std::move(surface));
}

void SceneBuilder::AddEdge(const Vector3d& start, const Vector3d& end) {
  if (!body_) scene_.edges.push_back({start, end});
}

// The box between a corner and three sides, a right-handed triple.
void SceneBuilder::AddBoxFaces(const Vector3d& corner,
                               const Eigen::Matrix3d& sides,
                               const BoxLook& look) {
  const Vector3d sx = sides.col(0), sy = sides.col(1), sz = sides.col(2);
  // The sides turn so that every normal points outward.
  const auto face = [&](const Vector3d& origin, const Vector3d& u, const Vector3d& v) {
    AddFace({origin, u, v, Recipe(look.material, look.tone), look.glow});
  };
  face(corner, sx, sz);
  face(corner + sx, sy, sz);
  face(corner + sx + sy, -sx, sz);
  face(corner + sy, -sy, sz);
  face(corner + sz, sx, sy);
  face(corner + sy, sx, -sy);
  AddPrismEdges({corner, corner + sx, corner + sx + sy, corner + sy}, sz);
}

void SceneBuilder::AddPrismEdges(const std::array<Vector3d, 4>& foot, const Vector3d& up) {
  for (std::size_t i = 0; i < foot.size(); ++i) {
    const Vector3d& a = foot[i];
    const Vector3d& b = foot[(i + 1) % foot.size()];
    AddEdge(a, b);
    AddEdge(a + up, b + up);
    AddEdge(a, a + up);
  }
}

void SceneBuilder::AddBox(const BoxShape& shape, Material material, double tone, double glow) {
  const Vector3d x(math::Cos(shape.yaw), math::Sin(shape.yaw), 0);
  const Vector3d y(-x.y(), x.x(), 0);
  Eigen::Matrix3d sides;
  sides << shape.size.x() * x, shape.size.y() * y, shape.size.z() * Vector3d::UnitZ();
  AddBoxFaces(shape.base - 0.5 * (sides.col(0) + sides.col(1)), sides, {material, tone, glow});
}

void SceneBuilder::AddPlacedBox(const Rigid3& world_from_box,
                                const Vector3d& size,
                                Material material,
                                double tone) {
  const Eigen::Matrix3d sides = world_from_box.rotation.toRotationMatrix() * size.asDiagonal();
  const Vector3d corner = world_from_box.translation - 0.5 * sides.rowwise().sum();
  AddBoxFaces(corner, sides, {material, tone, 0});
}

void SceneBuilder::AddBar(
    const Vector3d& start, const Vector3d& end, double thickness, Material material, double tone) {
  const Vector3d along = (end - start).normalized();
  const Vector3d guide = std::abs(along.z()) > 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
  Eigen::Matrix3d axes;
  axes.col(0) = along;
  axes.col(1) = guide.cross(along).normalized();
  axes.col(2) = along.cross(axes.col(1));
  AddPlacedBox({Eigen::Quaterniond(axes), 0.5 * (start + end)},
               {(end - start).norm(), thickness, thickness},
               material,
               tone);
}

void SceneBuilder::AddPrism(const Vector3d& start,
                            const Vector3d& end,
                            const PrismShape& shape,
                            Material material,
                            double tone) {
  PLUMBLINE_CHECK(shape.sides >= 4 && shape.sides % 2 == 0, "even number of sides of a prism");
  constexpr double kApart = 0.002;
  const Vector3d axis = (end - start).normalized();
  const Vector3d guide = std::abs(axis.z()) > 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d a = guide.cross(axis).normalized(), b = axis.cross(a);
  const auto corner = [&](int i) -> Vector3d {
    const double angle = 2 * std::numbers::pi * i / shape.sides;
    return shape.radius * (math::Cos(angle) * a + math::Sin(angle) * b);
  };
  TextureRecipe mantle = Recipe(material, tone);
  const double side = (corner(1) - corner(0)).norm();
  mantle.sheet_width = side * shape.sides;
  mantle.sheet_height = (end - start).norm();
  for (int i = 0; i < shape.sides; ++i) {
    mantle.sheet_u = side * i;
    AddFace({start + corner(i), corner(i + 1) - corner(i), end - start, mantle});
    AddEdge(start + corner(i), end + corner(i));
    AddEdge(start + corner(i), start + corner(i + 1));
    AddEdge(end + corner(i), end + corner(i + 1));
  }
  // A side seen from the axis spans no more than itself: the strips cover the whole polygon.
  for (int i = 0; i < shape.sides / 2; ++i) {
    const Vector3d along = corner(i + 1) - corner(i),
                   across = corner(i + shape.sides / 2 + 1) - corner(i);
    const Vector3d in = (shape.lid + kApart * i) * axis;
    AddFace({start + corner(i) + in, across, along, Recipe(material, tone)});
    AddFace({end + corner(i) - in, along, across, Recipe(material, tone)});
  }
}

void SceneBuilder::AddPanel(const Vector3d& origin,
                            const Vector3d& side_u,
                            const Vector3d& side_v,
                            const PanelLook& look) {
  AddFace({origin, side_u, side_v, Recipe(look.material, look.tone), look.glow, look.circuit});
  if (!look.edges) return;
  AddEdge(origin, origin + side_u);
  AddEdge(origin + side_v, origin + side_u + side_v);
  AddEdge(origin, origin + side_v);
  AddEdge(origin + side_u, origin + side_u + side_v);
}

// One face of a wall, in pieces around its holes: below, above and between them.
void SceneBuilder::AddWallFace(const Surface& whole, std::span<const Opening> openings) {
  const double length = whole.side_u.norm(), height = whole.side_v.norm();
  const Vector3d u = whole.side_u / length, v = whole.side_v / height;
  const auto piece = [&](double left, double right, double bottom, double top) {
    if (right - left < 1e-9 || top - bottom < 1e-9) return;
    Surface part = whole;
    part.origin = whole.origin + left * u + bottom * v;
    part.side_u = (right - left) * u;
    part.side_v = (top - bottom) * v;
    part.texture.sheet_u = left;
    part.texture.sheet_v = bottom;
    part.texture.sheet_width = length;
    part.texture.sheet_height = height;
    AddFace(part);
  };
  double left = 0;
  for (const Opening& hole : openings) {
    piece(left, hole.along, 0, height);
    piece(hole.along, hole.along + hole.width, 0, hole.bottom);
    piece(hole.along, hole.along + hole.width, hole.bottom + hole.height, height);
    left = hole.along + hole.width;
  }
  piece(left, length, 0, height);
}

void SceneBuilder::AddWall(const WallShape& shape,
                           std::span<const Opening> openings,
                           Material material,
                           double tone) {
  const Vector3d whole = shape.end - shape.start;
  const double length = whole.norm();
  const Vector3d u = whole / length, up = Vector3d::UnitZ();
  const Vector3d across = up.cross(u);  // to the left of start -> end
  const Vector3d half = 0.5 * shape.thickness * across;
  const TextureRecipe left_look = Recipe(material, tone), right_look = Recipe(material, tone);

  // The right side looks along u from the start; the left one from the end, so that the normals
  // point outward; its holes are counted from its own start.
  AddWallFace({shape.start - half, whole, shape.height * up, right_look}, openings);
  std::vector<Opening> mirrored(openings.rbegin(), openings.rend());
  double last = length;
  for (Opening& hole : mirrored) {
    PLUMBLINE_CHECK(hole.along + hole.width <= last + 1e-9 && hole.along >= -1e-9,
                    "holes of a wall lie inside it, sorted, and do not overlap");
    PLUMBLINE_CHECK(hole.bottom >= 0 && hole.bottom + hole.height <= shape.height + 1e-9,
                    "holes of a wall are no taller than it");
    last = hole.along;
    hole.along = length - hole.along - hole.width;
  }
  AddWallFace({shape.end + half, -whole, shape.height * up, left_look}, mirrored);
  AddFace({shape.start + half, -2 * half, shape.height * up, Recipe(material, tone)});
  AddFace({shape.end - half, 2 * half, shape.height * up, Recipe(material, tone)});
  AddFace({shape.start - half + shape.height * up, whole, 2 * half, Recipe(material, tone)});
  AddPrismEdges({shape.start - half, shape.end - half, shape.end + half, shape.start + half},
                shape.height * up);
  for (const Opening& hole : openings) AddReveals(shape, hole, material, tone);
}

// The four faces inside a hole of a wall and the edges around it.
void SceneBuilder::AddReveals(const WallShape& shape,
                              const Opening& hole,
                              Material material,
                              double tone) {
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d u = (shape.end - shape.start).normalized();
  const Vector3d across = shape.thickness * up.cross(u);
  const Vector3d near = shape.start - 0.5 * across + hole.along * u + hole.bottom * up;
  const Vector3d wide = hole.width * u, tall = hole.height * up;
  AddFace({near, across, tall, Recipe(material, tone)});                   // looks along +u
  AddFace({near + wide + across, -across, tall, Recipe(material, tone)});  // looks along -u
  AddFace({near + tall, across, wide, Recipe(material, tone)});            // looks down
  if (hole.bottom > 0) AddFace({near, wide, across, Recipe(material, tone)});
  for (const Vector3d& side : {Vector3d::Zero().eval(), across}) {
    AddEdge(near + side, near + side + tall);
    AddEdge(near + side + wide, near + side + wide + tall);
    AddEdge(near + side + tall, near + side + wide + tall);
    if (hole.bottom > 0) AddEdge(near + side, near + side + wide);
  }
  AddEdge(near + tall, near + tall + across);
  AddEdge(near + wide + tall, near + wide + tall + across);
  if (hole.bottom > 0) {
    AddEdge(near, near + across);
    AddEdge(near + wide, near + wide + across);
  }
}

void SceneBuilder::AddFaceWithHoles(const Vector3d& origin,
                                    const Vector3d& side_u,
                                    const Vector3d& side_v,
                                    std::span<const Opening> openings,
                                    const PanelLook& look) {
  AddWallFace({origin, side_u, side_v, Recipe(look.material, look.tone), look.glow, look.circuit},
              openings);
}

void SceneBuilder::AddFloor(const Vector3d& corner,
                            const Eigen::Vector2d& size,
                            Material material,
                            double tone) {
  AddFace(
      {corner, size.x() * Vector3d::UnitX(), size.y() * Vector3d::UnitY(), Recipe(material, tone)});
}

void SceneBuilder::AddCeiling(const Vector3d& corner,
                              const Eigen::Vector2d& size,
                              Material material,
                              double tone) {
  AddFace(
      {corner, size.y() * Vector3d::UnitY(), size.x() * Vector3d::UnitX(), Recipe(material, tone)});
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
  AddPrismEdges({o, x, x + y, y}, z);
}

void SceneBuilder::AddCeilingLamp(const Vector3d& centre,
                                  const Eigen::Vector2d& size,
                                  double power,
                                  int circuit) {
  constexpr double kGlow = 1.5;
  const Vector3d u = size.y() * Vector3d::UnitY(), v = size.x() * Vector3d::UnitX();  // looks down
  AddPanel(centre - 0.5 * (u + v), u, v, {Material::kBlank, 0.95, true, kGlow, circuit});
  AddLamp({centre - 0.01 * Vector3d::UnitZ(), u, v, power, circuit});
}

int SceneBuilder::AddCircuit(std::function<double(double)> level) {
  scene_.circuits.push_back({std::move(level)});
  return static_cast<int>(scene_.circuits.size());
}

void SceneBuilder::BeginBody(std::function<Rigid3(double)> world_from_body) {
  body_ = static_cast<int>(scene_.bodies.size());
  scene_.bodies.push_back({std::move(world_from_body)});
}

}  // namespace plumbline
