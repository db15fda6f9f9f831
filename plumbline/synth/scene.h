// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"
#include "plumbline/synth/texture.h"

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A flat rectangle: origin + a * side_u + b * side_v, a and b in [0, 1], side_u normal to side_v.
// Metres, world frame (z up). Seen from both sides, lit on the side of its normal.
struct Surface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d side_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d side_v = Eigen::Vector3d::UnitY();
  TextureRecipe texture;
  double glow = 0;  // light of its own, 1 for a white lamp

  Eigen::Vector3d PointAt(double a, double b) const { return origin + a * side_u + b * side_v; }
  Eigen::Vector3d Normal() const { return side_u.cross(side_v).normalized(); }
};

// A small lamp: shines equally in all directions, fades with the square of the distance.
struct Lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world, metres
  double power = 1;  // brightness of a white surface facing it at 1 m; 1 is white in the image
};

// A still world of rectangles under lamps, and the straight edges of its bodies: what a perfect
// line map of it would hold. Lines that are only painted on a surface are not among them.
struct Scene {
  std::vector<Surface> surfaces;
  std::vector<Segment3> edges;
  std::vector<Lamp> lamps;
  double ambient = 0.2;  // light that reaches every surface
};

// A box standing at a place, turned about the vertical.
struct BoxShape {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  // centre of the bottom face
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // along its own x, y and up
  double yaw = 0;                                  // radians, from world x towards y
};

// Puts bodies together and keeps each surface's texture its own.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::uint64_t seed) : seed_(seed) {}

  // The six faces and twelve edges of a box.
  void AddBox(const BoxShape& shape, Material material, double tone, double glow = 0);

  void AddLamp(const Lamp& lamp) { scene_.lamps.push_back(lamp); }

  // The inside of a room: floor at z = 0, corner at the origin, the given size.
  void AddRoom(const Eigen::Vector3d& size, Material wall, Material floor);

  // A uniform number in [low, high), the next of the builder's own sequence.
  double Random(double low, double high);

  Scene Take() { return std::move(scene_); }

 private:
  void AddFace(const Surface& surface) { scene_.surfaces.push_back(surface); }
  TextureRecipe Recipe(Material material, double tone, double corner_shade = 0);

  std::uint64_t seed_;
  std::uint64_t count_ = 0;
  Scene scene_;
};

// The world `room`: a workshop of 6.4 x 5.2 x 2.8 m with shelves, tables, posters, a door, a window
// with blinds, pipes and boxes; the middle is free to walk in.
Scene MakeRoom(std::uint64_t seed);

// Size of that room, metres.
Eigen::Vector3d RoomSize();

}  // namespace plumbline
