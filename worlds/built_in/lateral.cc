// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <utility>

namespace plumbline {
namespace lateral {

using Eigen::Vector3d;

constexpr double kLength = 18, kDepth = 5, kHeight = 3.2, kThickness = 0.32;
constexpr double kModule = 1.75;
constexpr std::size_t kModules = 10;

void AddNiche(SceneBuilder& scene, const Place& wall, const Opening& hole) {
  AddBacking(scene, wall, hole, kThickness - 0.02, {Material::kPlaster, 0.4, false});
  const double middle = hole.along + 0.5 * hole.width, left = hole.along + 0.02;
  for (const double share : {0.0, 0.5}) {
    const double z = hole.bottom + share * hole.height;
    if (share > 0) {
      AddPart(
          scene, wall, {{middle, -0.15, z}, {hole.width, 0.26, 0.025}, 0}, Material::kWood, 0.55);
    }
    AddThings(scene,
              {wall.At(left, -0.15, share > 0 ? z + 0.025 : z), wall.facing},
              hole.width - 0.04,
              0.4 * hole.height);
  }
}

void AddShelves(SceneBuilder& scene, const Place& wall, double x) {
  for (const double z : {0.9, 1.35, 1.8}) {
    AddPart(scene, wall, {{x, 0.14, z}, {1.3, 0.26, 0.03}, 0}, Material::kWood, 0.6);
    for (const double side : {-0.5, 0.5}) {
      AddPart(
          scene, wall, {{x + side, 0.1, z - 0.16}, {0.03, 0.19, 0.16}, 0}, Material::kMetal, 0.3);
    }
    AddThings(scene, {wall.At(x - 0.62, 0.14, z + 0.03), wall.facing}, 1.24, 0.35);
  }
}

void AddBrickField(SceneBuilder& scene, const Place& wall, double x) {
  AddPart(scene, wall, {{x, 0.04, 0.3}, {1.3, 0.06, 2.4}, 0}, Material::kBrick, 0.5);
  AddPicture(scene, {wall.At(x, 0.07, 1.1), wall.facing}, {0.7, 1.0}, Material::kPoster);
}

void AddHeating(SceneBuilder& scene, const Place& wall, double x) {
  AddRadiator(scene, {wall.At(x, 0, 0), wall.facing}, 1.2);
  AddPart(scene, wall, {{x, 0.14, 0.86}, {1.4, 0.26, 0.035}, 0}, Material::kConcrete, 0.65);
  AddThings(scene, {wall.At(x - 0.5, 0.14, 0.895), wall.facing}, 0.8, 0.3);
  AddPicture(scene, {wall.At(x, 0, 1.4), wall.facing}, {1.1, 0.8}, Material::kMural);
}

void AddPipes(SceneBuilder& scene, const Place& wall, double x) {
  for (const double dx : {-0.5, -0.36, -0.26}) {
    AddBarAt(scene,
             wall,
             {{x + dx, 0.1, 0.005}, {x + dx, 0.1, kHeight - 0.005}, scene.Random(0.04, 0.08)},
             Material::kMetal,
             scene.Random(0.35, 0.7));
  }
  AddPart(scene, wall, {{x + 0.2, 0.09, 1.1}, {0.6, 0.16, 0.8}, 0}, Material::kMetal, 0.55);
  AddPart(scene, wall, {{x + 0.2, 0.176, 1.14}, {0.52, 0.01, 0.72}, 0}, Material::kPaint, 0.65);
  AddPart(scene, wall, {{x + 0.1, 0.189, 1.55}, {0.24, 0.01, 0.16}, 0}, Material::kPoster, 0.8);
  AddBarAt(scene,
           wall,
           {{x + 0.2, 0.09, 1.905}, {x + 0.2, 0.09, kHeight - 0.3}, 0.03},
           Material::kBlank,
           0.7);
}

void AddSeat(SceneBuilder& scene, const Place& wall, double x) {
  AddPart(scene, wall, {{x, 0.25, 0.42}, {1.4, 0.42, 0.05}, 0}, Material::kWood, 0.5);
  for (const double side : {-0.6, 0.6}) {
    AddPart(scene, wall, {{x + side, 0.25, 0}, {0.05, 0.4, 0.42}, 0}, Material::kMetal, 0.3);
  }
  AddPart(scene,
          wall,
          {{x + scene.Random(-0.3, 0.3), 0.25, 0.47}, {0.5, 0.3, 0.28}, 0.2},
          Material::kCardboard,
          0.6);
  for (int i = 0; i < 6; ++i) {  // a rail of hooks with bags
    AddPart(scene,
            wall,
            {{x - 0.55 + 0.22 * i, 0.06, 1.62}, {0.02, 0.08, 0.02}, 0},
            Material::kMetal,
            0.3);
    if (scene.Random(0, 1) < 0.4) continue;
    AddPart(scene,
            wall,
            {{x - 0.55 + 0.22 * i, 0.1, 1.1}, {0.16, 0.1, 0.5}, 0},
            Material::kFabric,
            scene.Random(0.15, 0.8));
  }
  AddPart(scene, wall, {{x, 0.012, 1.58}, {1.35, 0.016, 0.1}, 0}, Material::kWood, 0.65);
}

void AddModule(SceneBuilder& scene, const ShellShape& shell, std::size_t kind, double x) {
  const Place wall = shell.Wall(2);
  switch (kind) {
    case 0:
      break;  // a niche, made with the wall
    case 1:
      AddShelves(scene, wall, x);
      break;
    case 2:
      AddBrickField(scene, wall, x);
      break;
    case 3:
      AddHeating(scene, wall, x);
      break;
    case 4:
      AddPipes(scene, wall, x);
      break;
    default:
      AddSeat(scene, wall, x);
      break;
  }
}

void AddPillarsAndLamps(SceneBuilder& scene, const Place& wall) {
  for (std::size_t i = 0; i + 1 < kModules; i += 2) {
    const double x = 0.25 + kModule * (static_cast<double>(i) + 1);
    AddPart(scene, wall, {{x, 0.085, 0}, {0.22, 0.17, kHeight}, 0}, Material::kConcrete, 0.5);
  }
  for (int i = 0; i < 5; ++i) {
    AddTubeLamp(scene, {wall.At(1.8 + 3.6 * i, 1.5, kHeight - 0.35), wall.facing}, {1.5, 4.4});
    AddTubeLamp(scene, {wall.At(1.8 + 3.6 * i, 3.6, kHeight - 0.35), wall.facing}, {1.5, 2.6});
  }
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  // Every kind of module once or twice, in an order of the seed.
  std::array<std::size_t, kModules> kinds = {0, 1, 2, 3, 4, 5, 0, 1, 2, 4};
  for (std::size_t i = kModules - 1; i > 0; --i) {
    std::swap(kinds[i],
              kinds[static_cast<std::size_t>(scene.Random(0, 1) * static_cast<double>(i + 1))]);
  }
  ShellShape shell;
  shell.size = {kLength, kDepth, kHeight};
  shell.thickness = kThickness;
  shell.walls = {Finish{Material::kPlaster, 0.55},
                 {Material::kBrick, 0.5},
                 {Material::kPlaster, 0.6},
                 {Material::kPlaster, 0.5}};
  shell.floor = {Material::kPlanks, 0.5};
  shell.ceiling = {Material::kAcoustic, 0.75};
  const auto middle = [](std::size_t i) { return 0.25 + kModule * (static_cast<double>(i) + 0.5); };
  for (std::size_t i = 0; i < kModules; ++i) {
    if (kinds[i] == 0) shell.openings[2].push_back({middle(i) - 0.65, 1.3, 0.7, 1.5});
  }
  AddShell(scene, shell);
  AddSkirting(scene, shell, {Material::kWood, 0.35});
  for (const Opening& hole : shell.openings[2]) AddNiche(scene, shell.Wall(2), hole);
  for (std::size_t i = 0; i < kModules; ++i) AddModule(scene, shell, kinds[i], middle(i));
  AddPillarsAndLamps(scene, shell.Wall(2));
  scene.SetAmbient(0.25);

  // To one end, back, and a little of the way again, at changing height.
  constexpr double kAhead = 0.5 * std::numbers::pi;
  const double away = kDepth - scene.Random(2.1, 2.4);
  std::vector<Waypoint> way = {{{2.2, away, 1.4}, kAhead, 0.04},
                               {{6.0, away, 1.45}, kAhead, 0.04},
                               {{11.0, away - 0.1, 1.5}, kAhead, 0.05},
                               {{15.8, away, 1.45}, kAhead, 0.05},
                               {{15.8, away + 0.1, 1.2}, kAhead, 0},
                               {{10.0, away + 0.1, 1.2}, kAhead, 0},
                               {{6.5, away, 1.25}, kAhead, 0}};
  return {scene.Take(), WithCarrier(SplinePath(way, {0.7, 0.5}), Carrier::kWheels, seed)};
}

}  // namespace lateral

World MakeLateral(std::uint64_t seed) { return lateral::Make(seed); }

}  // namespace plumbline
