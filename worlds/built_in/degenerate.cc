// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <numbers>
#include <vector>

namespace plumbline {
namespace degenerate {

using Eigen::Vector3d;

constexpr double kLength = 20, kDepth = 5, kHeight = 3;

// All long edges are along x: in the epipolar planes of a pair with its baseline and motion along
// x.
void AddRails(SceneBuilder& scene, const Place& wall) {
  constexpr double kEnds = 0.03, kMiddle = 0.5 * kLength, kLong = kLength - 2 * kEnds;
  const auto board = [&](double out, double z, double deep, double high, const Finish& finish) {
    AddPart(scene,
            wall,
            {{kMiddle, out + 0.5 * deep, z}, {kLong, deep, high}, 0},
            finish.material,
            finish.tone);
  };
  board(0, 0, 0.02, 0.1, {Material::kBlank, 0.35});         // skirting
  board(0, 0.85, 0.03, 0.14, {Material::kBlank, 0.3});      // bumper rail
  board(0.03, 0.895, 0.03, 0.05, {Material::kBlank, 0.7});  // its grip
  board(0, 1.32, 0.2, 0.03, {Material::kBlank, 0.45});      // shelf
  board(0, 2.3, 0.08, 0.12, {Material::kBlank, 0.8});       // cable duct
  for (const double z : {1.85, 1.97, 2.12}) {               // pipes on the wall
    const double thick = z > 2 ? 0.08 : 0.045;
    AddBarAt(scene,
             wall,
             {{kEnds, 0.1, z}, {kLength - kEnds, 0.1, z}, thick},
             Material::kBlank,
             scene.Random(0.3, 0.7));
  }
  for (const double y : {1.0, 2.0, 3.2}) {  // beams under the ceiling
    board(y, kHeight - 0.2, 0.14, 0.198, {Material::kBlank, 0.5});
  }
  for (const double y : {1.3, 1.42}) {  // lines on the floor
    scene.AddPanel(wall.At(kLength - kEnds, y + 0.05, 0.003),
                   -kLong * Along(wall),
                   -0.05 * Out(wall),
                   {Material::kBlank, 0.85});
  }
}

// The little there is that does give depth: posts, brackets, a few signs.
void AddSparseThings(SceneBuilder& scene, const Place& wall) {
  double x = scene.Random(0.6, 1.2);
  int kind = 0;
  while (x < kLength - 0.6) {
    switch (kind++ % 4) {
      case 0:
        AddPicture(scene, {wall.At(x, 0, 1.39), wall.facing}, {0.3, 0.4}, Material::kPoster);
        break;
      case 1:
        AddPart(scene,
                wall,
                {{x, 0.1, 1.35}, {scene.Random(0.15, 0.3), 0.16, scene.Random(0.12, 0.3)}, 0},
                Material::kCardboard,
                scene.Random(0.35, 0.7));
        break;
      case 2:
        AddSocket(scene, {wall.At(x, 0, 0.4), wall.facing});
        AddSocket(scene, {wall.At(x + 0.1, 0, 0.4), wall.facing});
        break;
      default:
        AddPart(scene, wall, {{x, 0.21, 0}, {0.35, 0.3, 0.5}, 0}, Material::kMetal, 0.4);
        break;
    }
    x += scene.Random(0.7, 1.1);
  }
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  ShellShape shell;
  shell.size = {kLength, kDepth, kHeight};
  shell.walls = {Finish{Material::kBlank, 0.6},
                 {Material::kPlaster, 0.55},
                 {Material::kBlank, 0.65},
                 {Material::kPlaster, 0.55}};
  shell.floor = {Material::kBlank, 0.4};
  shell.ceiling = {Material::kBlank, 0.75};
  AddShell(scene, shell);
  const Place wall = shell.Wall(2);
  AddRails(scene, wall);
  AddSparseThings(scene, wall);
  for (int i = 0; i < 5; ++i) {
    AddTubeLamp(scene, {wall.At(2 + 4.0 * i, 2.6, kHeight - 0.35), wall.facing}, {3.0, 10.5});
  }
  scene.SetAmbient(0.3);

  // Along x and back, the baseline along x all the way; only its distance changes between.
  constexpr double kAhead = 0.5 * std::numbers::pi;
  const double away = kDepth - scene.Random(2.0, 2.3);
  const std::vector<Waypoint> way = {{{2.8, away, 1.45}, kAhead, 0},
                                     {{9.0, away, 1.45}, kAhead, 0},
                                     {{17.0, away, 1.45}, kAhead, 0},
                                     {{17.0, away - 0.3, 1.45}, kAhead, 0},
                                     {{5.0, away - 0.3, 1.45}, kAhead, 0}};
  return {scene.Take(), WithCarrier(SplinePath(way, {0.7, 0.5}), Carrier::kWheels, seed)};
}

}  // namespace degenerate

World MakeDegenerate(std::uint64_t seed) { return degenerate::Make(seed); }

}  // namespace plumbline
