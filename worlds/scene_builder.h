// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace plumbline {

// A box at a place, rotated about the vertical.
struct BoxShape {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  // centre of the bottom face
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // along its own x, y and up
  double yaw = 0;                                  // radians, from world x towards y
};

// A hole in a wall: a door (bottom 0), a window or a passage.
struct Opening {
  double along = 0;   // of its near side from the start of the wall, metres
  double width = 1;   // metres
  double bottom = 0;  // above the foot of the wall, metres
  double height = 2;  // metres
};

// A wall from one point of the floor to another. It has the thickness `thickness` and is symmetric
// about the line from start to end; its holes go through it.
struct WallShape {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::UnitX();  // at the height of start
  double height = 2.6;
  double thickness = 0.1;
};

// Cross-section of a round object: a regular polygon.
struct PrismShape {
  double radius = 0.1;  // to its corners, metres
  int sides = 6;        // even
  double lid = 0;       // depth of its ends inside its rim, metres
};

// Appearance of a panel.
struct PanelLook {
  Material material = Material::kPaint;
  double tone = 0.5;
  bool edges = true;  // true if its rim adds four edges to the world
  double glow = 0;
  int circuit = 0;
};

// Builds scenes of bodies, each surface with its own texture.
//
// Everything added between BeginBody and EndBody belongs to a moving body, is given in its frame,
// and has no edges in Scene::edges.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::uint64_t seed) : seed_(seed) {}

  // The six faces and twelve edges of a box.
  void AddBox(const BoxShape& shape, Material material, double tone, double glow = 0);

  // A box in any position: `world_from_box` is the pose of its centre, `size` lies along its axes.
  void AddPlacedBox(const Rigid3& world_from_box,
                    const Eigen::Vector3d& size,
                    Material material,
                    double tone);

  // A thin straight bar of square section from one point to another (a wire, a rail, a leg).
  void AddBar(const Eigen::Vector3d& start,
              const Eigen::Vector3d& end,
              double thickness,
              Material material,
              double tone);

  // A drum, pipe or post between the middles of its ends. Its ends are strips from side to opposite
  // side, 2 mm apart.
  void AddPrism(const Eigen::Vector3d& start,
                const Eigen::Vector3d& end,
                const PrismShape& shape,
                Material material,
                double tone);

  // A rectangle in space: origin, two sides normal to each other, visible from both sides, lit from
  // the side of side_u x side_v.
  void AddPanel(const Eigen::Vector3d& origin,
                const Eigen::Vector3d& side_u,
                const Eigen::Vector3d& side_v,
                const PanelLook& look);

  // A wall with holes: both faces, the reveals of the holes, its ends and top. The texture
  // continues from piece to piece of a face. Edges: the outline and those of the holes, not the
  // seams between pieces. Holes must lie inside the wall, must not overlap along it, and are sorted
  // by `along`.
  void AddWall(const WallShape& shape,
               std::span<const Opening> openings,
               Material material,
               double tone);

  // One face of a wall seen from the side of side_u x side_v (side_v up), with holes as in AddWall.
  // No edges.
  void AddFaceWithHoles(const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& side_u,
                        const Eigen::Vector3d& side_v,
                        std::span<const Opening> openings,
                        const PanelLook& look);

  // A floor (facing up) or a ceiling (facing down): `corner` and the size along x and y. No edges,
  // since the adjacent walls add them.
  void AddFloor(const Eigen::Vector3d& corner,
                const Eigen::Vector2d& size,
                Material material,
                double tone);
  void AddCeiling(const Eigen::Vector3d& corner,
                  const Eigen::Vector2d& size,
                  Material material,
                  double tone);

  // The inside of a room: floor at z = 0, corner at the origin, the given size.
  void AddRoom(const Eigen::Vector3d& size, Material wall, Material floor);

  void AddLamp(const Lamp& lamp) { scene_.lamps.push_back(lamp); }

  // A ceiling lamp: a glowing panel facing down, `size` along x and y, with its light.
  void AddCeilingLamp(const Eigen::Vector3d& centre,
                      const Eigen::Vector2d& size,
                      double power,
                      int circuit = 0);

  // Adds a circuit for lamps; returns its number.
  int AddCircuit(std::function<double(double)> level);

  void BeginBody(std::function<Rigid3(double)> world_from_body);
  void EndBody() { body_.reset(); }

  // Adds an edge explicitly (of objects made of panels).
  void AddEdge(const Eigen::Vector3d& start, const Eigen::Vector3d& end);

  void SetAmbient(double ambient) { scene_.ambient = ambient; }

  // A uniform number in [low, high), the next of the builder's own sequence.
  double Random(double low, double high);

  Scene Take() { return std::move(scene_); }

 private:
  struct BoxLook {
    Material material;
    double tone;
    double glow;
  };

  void AddFace(Surface surface);
  void AddBoxFaces(const Eigen::Vector3d& corner,
                   const Eigen::Matrix3d& sides,
                   const BoxLook& look);
  void AddPrismEdges(const std::array<Eigen::Vector3d, 4>& foot, const Eigen::Vector3d& up);
  void AddWallFace(const Surface& whole, std::span<const Opening> openings);
  void AddReveals(const WallShape& shape, const Opening& hole, Material material, double tone);
  TextureRecipe Recipe(Material material, double tone, double corner_shade = 0);

  std::uint64_t seed_;
  std::uint64_t count_ = 0;
  std::optional<int> body_;
  Scene scene_;
};

}  // namespace plumbline
