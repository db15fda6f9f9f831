// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <cstddef>

namespace plumbline {
namespace forward {

using Eigen::Vector3d;

constexpr double kLength = 33, kWidth = 5.4, kHeight = 4.0, kThickness = 0.45;
constexpr double kBay = 4.0, kFirstBay = 0.5;
constexpr int kBays = 8;

// The display behind a shop window: a back wall, a shelf and goods on it and on the sill.
void AddDisplay(SceneBuilder& scene, const Place& wall, const Opening& hole) {
  const double middle = hole.along + 0.5 * hole.width;
  AddBacking(scene,
             wall,
             hole,
             kThickness - 0.02,
             {scene.Random(0, 1) < 0.5 ? Material::kMural : Material::kFabric,
              scene.Random(0.35, 0.7),
              false});
  const double shelf = hole.bottom + scene.Random(0.75, 0.95);
  AddPart(scene,
          wall,
          {{middle, -0.28, shelf}, {hole.width - 0.01, 0.26, 0.03}, 0},
          Material::kWood,
          0.6);
  for (const double floor : {hole.bottom, shelf + 0.03}) {
    double x = hole.along + 0.06;
    while (x < hole.along + hole.width - 0.4) {
      const double wide = scene.Random(0.12, 0.34), tall = scene.Random(0.12, 0.6);
      const Material looks[] = {
          Material::kPoster, Material::kCardboard, Material::kSpine, Material::kWood};
      AddPart(scene,
              wall,
              {{x + 0.5 * wide, -0.27, floor}, {wide, scene.Random(0.08, 0.2), tall}, 0},
              looks[static_cast<std::size_t>(scene.Random(0, 3.99))],
              scene.Random(0.3, 0.9));
      x += wide + scene.Random(0.02, 0.2);
    }
  }
  // Frame of the pane, in the plane of the wall.
  for (const double side : {-0.5, 0.0, 0.5}) {
    const double inset = -0.06 * side;
    AddPart(
        scene,
        wall,
        {{middle + side * hole.width + inset, -0.04, hole.bottom}, {0.05, 0.05, hole.height}, 0},
        Material::kMetal,
        0.3);
  }
}

// A shop: a window and a door, a sign above, a lamp or an awning.
void AddShop(SceneBuilder& scene, const Place& wall, const Opening& window, double door) {
  AddDisplay(scene, wall, window);
  AddDoor(scene,
          {wall.At(door, 0, 0), wall.facing},
          {0.9, 2.1, static_cast<int>(scene.Random(0, 2.99)), scene.Random(0.3, 0.75)});
  const double middle = window.along + 0.5 * window.width;
  AddPicture(scene,
             {wall.At(middle, 0, 2.75), wall.facing},
             {scene.Random(1.6, 2.1), 0.5},
             Material::kPoster);
  if (scene.Random(0, 1) < 0.5) {  // a sign that stands out from the wall
    AddPart(scene, wall, {{door, 0.4, 2.55}, {0.05, 0.6, 0.6}, 0}, Material::kPoster, 0.7);
    AddBarAt(scene, wall, {{door, 0, 3.2}, {door, 0.75, 3.2}, 0.03}, Material::kMetal, 0.3);
  }
  AddPart(scene,
          wall,
          {{middle, 0.03, 0.3}, {window.width + 0.1, 0.05, 0.12}, 0},
          Material::kConcrete,
          0.6);
}

// Objects along the walls: benches, bins, crates, plants in tubs.
void AddStreetThing(SceneBuilder& scene, const Place& wall, double along) {
  const double kind = scene.Random(0, 4);
  if (kind < 1) {  // a bench
    for (const double y : {0.35, 0.48, 0.61}) {
      AddPart(scene, wall, {{along, y, 0.42}, {1.4, 0.1, 0.035}, 0}, Material::kWood, 0.55);
    }
    for (const double x : {-0.55, 0.55}) {
      AddPart(scene, wall, {{along + x, 0.48, 0}, {0.06, 0.36, 0.42}, 0}, Material::kMetal, 0.3);
    }
  } else if (kind < 2) {  // crates
    double z = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector3d size(scene.Random(0.4, 0.6), scene.Random(0.35, 0.45), 0.3);
      AddPart(scene,
              wall,
              {{along, 0.45, z}, size, scene.Random(-0.3, 0.3)},
              i == 1 ? Material::kWood : Material::kCardboard,
              scene.Random(0.4, 0.7));
      z += size.z();
    }
  } else if (kind < 3) {  // a plant
    AddPart(scene, wall, {{along, 0.4, 0}, {0.4, 0.4, 0.42}, 0.3}, Material::kConcrete, 0.5);
    for (int i = 0; i < 14; ++i) {
      const Vector3d tip(along + scene.Random(-0.35, 0.35),
                         0.4 + scene.Random(-0.3, 0.35),
                         scene.Random(0.8, 1.5));
      AddBarAt(
          scene, wall, {{along, 0.4, 0.4}, tip, 0.025}, Material::kFabric, scene.Random(0.15, 0.4));
    }
  } else {  // a board with bills
    AddPart(scene, wall, {{along, 0.5, 0.1}, {0.7, 0.04, 1.1}, 0.5}, Material::kPoster, 0.75);
    AddPart(scene, wall, {{along, 0.5, 0}, {0.5, 0.3, 0.05}, 0.5}, Material::kMetal, 0.3);
  }
}

void AddSide(SceneBuilder& scene, const ShellShape& shell, std::size_t k) {
  const Place wall = shell.Wall(k);
  for (const Opening& window : shell.openings[k]) {
    AddShop(scene, wall, window, window.along + window.width + 0.85);
    const double pillar = window.along - 0.45;
    AddPart(
        scene, wall, {{pillar, 0.125, 0}, {0.42, 0.25, kHeight - 0.3}, 0}, Material::kBrick, 0.5);
    AddPart(scene, wall, {{pillar, 0.14, 0}, {0.48, 0.28, 0.35}, 0}, Material::kConcrete, 0.5);
    AddStreetThing(scene, wall, window.along + scene.Random(0.5, 1.2));
  }
}

void AddRoof(SceneBuilder& scene) {
  for (int i = 0; i < kBays; ++i) {
    const double x = kFirstBay + kBay * i;
    scene.AddBox({{x, 0.5 * kWidth, kHeight - 0.28}, {0.25, kWidth - 0.01, 0.275}, 0},
                 Material::kWood,
                 0.45);
    const Place lamp{{x + 0.5 * kBay, 0.5 * kWidth, kHeight - 0.6}, 0};
    AddTubeLamp(scene, lamp, {1.8, 11});
    for (const double end : {-0.7, 0.7}) {
      AddBarAt(scene, lamp, {{end, 0, 0.062}, {end, 0, 0.598}, 0.012}, Material::kMetal, 0.4);
    }
  }
  for (const double y : {0.5, 0.7, kWidth - 0.6}) {  // pipes and a cable tray
    scene.AddBox({{0.5 * kLength, y, kHeight - 0.45}, {kLength - 0.02, 0.09, 0.09}, 0},
                 Material::kMetal,
                 0.6);
  }
}

ShellShape Shell(SceneBuilder& scene) {
  ShellShape shell;
  shell.size = {kLength, kWidth, kHeight};
  shell.thickness = kThickness;
  shell.walls = {Finish{Material::kPlaster, 0.6},
                 {Material::kBrick, 0.55},
                 {Material::kPlaster, 0.5},
                 {Material::kBrick, 0.55}};
  shell.floor = {Material::kTiles, 0.5};
  shell.ceiling = {Material::kPlanks, 0.45};
  for (const std::size_t k : {0U, 2U}) {
    for (int i = 0; i < kBays; ++i) {
      const double start = kFirstBay + kBay * i + (k == 0 ? 0.45 : 0.55);
      const bool wide = scene.Random(0, 1) < 0.6;
      shell.openings[k].push_back({start, wide ? 1.9 : 1.6, 0.5, 2.0});
    }
  }
  shell.openings[1].push_back({0.9, kWidth - 1.8, 0.9, 2.3});
  return shell;
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const ShellShape shell = Shell(scene);
  AddShell(scene, shell);
  AddSide(scene, shell, 0);
  AddSide(scene, shell, 2);
  AddRoof(scene);
  AddViewWindow(scene, shell.Wall(1), shell.openings[1].front(), {5, 9, 0.6});
  scene.SetAmbient(0.4);

  const double lane = 0.5 * kWidth + scene.Random(-0.15, 0.15);
  const double end = kLength - 9;
  const CameraPath straight =
      SplinePath({{{2.0, lane, 1.5}, 0, 0.03, 0},
                  {{0.5 * end, lane + scene.Random(-0.1, 0.1), 1.5}, 0, 0.03},
                  {{end, lane, 1.5}, 0, 0.03, 0}},
                 {0.6, 0.3});
  return {scene.Take(), WithCarrier(straight, Carrier::kWheels, seed)};
}

}  // namespace forward

World MakeForward(std::uint64_t seed) { return forward::Make(seed); }

}  // namespace plumbline
