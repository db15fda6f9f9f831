// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/worlds.h"
#include "worlds/scene_builder.h"

#include <numbers>
#include <vector>

namespace plumbline {

using Eigen::Vector3d;

// The camera hangs before a wall so large that it sees nothing else.
World MakePlanar(std::uint64_t seed) {
  constexpr double kWide = 13, kHigh = 10, kAhead = 0.5 * std::numbers::pi;
  SceneBuilder scene(seed);
  scene.AddPanel({-0.5 * kWide, 0, 0},
                 kWide * Vector3d::UnitX(),
                 kHigh * Vector3d::UnitZ(),
                 {Material::kMural, 0.5, false});
  scene.SetAmbient(0.45);
  for (const double side : {-1.0, 1.0}) {  // floodlights behind the camera, above its view
    scene.AddLamp({{4.0 * side, -5.5, 0.5 * kHigh + 2},
                   1.5 * Vector3d::UnitZ(),
                   1.5 * Vector3d::UnitX(),
                   scene.Random(7, 9)});
  }
  std::vector<Waypoint> way;
  const auto pass = [&](double x, double away, double z) {
    way.push_back({{x, -away, 0.5 * kHigh + z},
                   kAhead + scene.Random(-0.1, 0.1),
                   scene.Random(-0.08, 0.08),
                   scene.Random(-0.06, 0.06)});
  };
  pass(0, 2.0, 0);
  pass(0.9, 2.1, 0.1);
  pass(1.3, 2.0, 0.7);
  pass(0.2, 1.9, 0.8);
  pass(-1.2, 2.1, 0.6);
  pass(-1.4, 2.2, -0.3);
  pass(-0.3, 2.0, -0.7);
  pass(1.1, 1.8, -0.8);
  pass(1.5, 2.0, 0);
  pass(0, 2.3, 0.1);
  pass(-1.0, 2.1, 0);
  pass(-0.2, 2.0, 0.05);
  return {scene.Take(), WithCarrier(SplinePath(way, {0.4, 0.3}), Carrier::kHand, seed)};
}

}  // namespace plumbline
