// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace lights {

using Eigen::Vector3d;

constexpr double kWidth = 8.4, kDepth = 6.6, kHeight = 3.0;
constexpr double kDuration = 48;  // about that of the path

// A lamp that changes between on and off at given times, as fast as tubes do.
std::function<double(double)> Switched(std::vector<double> times, bool on) {
  constexpr double kRise = 0.09;  // seconds
  return [times = std::move(times), on](double time) {
    double level = on ? 1 : 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double x = std::clamp((time - times[i]) / kRise, 0.0, 1.0);
      const double change = x * x * (3 - 2 * x);
      level += ((i % 2 == 0) == on ? -1 : 1) * change;
    }
    return level;
  };
}

// Switched every few seconds, first after `start`.
int AddSwitch(SceneBuilder& scene, double start, bool on) {
  std::vector<double> times;
  for (double time = start; time < kDuration; time += scene.Random(4, 9)) times.push_back(time);
  return scene.AddCircuit(Switched(std::move(times), on));
}

void AddLamps(SceneBuilder& scene) {
  const CeilingGrid grid{{0, 0, kHeight}, {kWidth, kDepth}, 0.6, 0.75};
  AddCeilingGrid(scene, grid);
  // Rows along the windows, each with its own switch.
  const bool on[] = {true, true, false};
  const int columns[] = {2, 6, 11};
  for (int row = 0; row < 3; ++row) {
    const int circuit = AddSwitch(scene, 3.0 + 2.3 * row + scene.Random(0, 1.5), on[row]);
    for (int i = 0; i < 3; ++i) {
      AddGridLamp(scene, grid, {columns[row], 1 + 3 * i, 1, 2, 1.5, circuit});
    }
  }
}

void AddRowOfDesks(SceneBuilder& scene, double x, double first_y, int count) {
  for (int i = 0; i < count; ++i) {
    const Place desk{{x, first_y + 1.8 * i, 0}, std::numbers::pi};
    AddWorkplace(scene, desk, 1.5, 1 + i % 2);
    AddChair(scene,
             {desk.At(scene.Random(-0.2, 0.2), 1.1, 0),
              desk.facing + std::numbers::pi + scene.Random(-0.4, 0.4)});
  }
}

// A reading lamp on a desk: a foot, a stem and a glowing shade of its own circuit.
void AddReadingLamp(SceneBuilder& scene, const Vector3d& foot) {
  const int circuit = AddSwitch(scene, scene.Random(4, 7), false);
  scene.AddBox({foot, {0.16, 0.16, 0.02}}, Material::kBlank, 0.2);
  scene.AddBar(
      foot + Vector3d(0, 0, 0.02), foot + Vector3d(0, 0, 0.4), 0.015, Material::kBlank, 0.3);
  for (int side = 0; side < 4; ++side) {
    const Place face{foot + Vector3d(0, 0, 0.4), 0.5 * std::numbers::pi * side};
    scene.AddPanel(face.At(0.09, 0.09, 0),
                   -0.18 * Along(face),
                   0.16 * Vector3d::UnitZ(),
                   {Material::kFabric, 0.8, true, 0.8, circuit});
  }
  scene.AddLamp({foot + Vector3d(0, 0, 0.6), Vector3d::Zero(), Vector3d::Zero(), 0.3, circuit});
}

void Furnish(SceneBuilder& scene, const ShellShape& shell) {
  AddRowOfDesks(scene, 3.2, 2.4, 2);
  AddRowOfDesks(scene, 8.35, 1.5, 3);
  AddReadingLamp(scene, {3.0, 3.06, 0.74});
  AddReadingLamp(scene, {8.15, 3.96, 0.74});
  AddShelf(scene, shell.Wall(0, 1.4), {1.8, 1.95, 0.34, 5, 0.93, 0.5});
  AddDoor(scene, shell.Wall(0, 4.2), {0.95, 2.1, 2, 0.65});
  AddSocket(scene, shell.Wall(0, 4.95, 1.1));
  AddCabinet(scene, shell.Wall(0, 6.4), {1.4, 0.45, 1.2}, 4, 0.55);
  AddPicture(scene, shell.Wall(0, 6.4, 1.5), {1.2, 0.8}, Material::kMural);
  AddSheet(scene, shell.Wall(1, 1.4, 1.0), {1.6, 1.1}, Material::kPoster, 0.8);
  AddPicture(scene, shell.Wall(1, 3.2, 1.2), {0.7, 1.0}, Material::kPoster);
  AddPicture(scene, shell.Wall(1, 4.9, 1.2), {1.0, 0.8}, Material::kPoster);
  AddShelf(scene, shell.Wall(2, 1.2), {1.6, 1.6, 0.34, 4, 0.9, 0.6});
  AddSheet(scene, shell.Wall(2, 3.8, 0.9), {2.4, 1.2}, Material::kScreen, 0.8);
  AddCabinet(scene, shell.Wall(2, 6.3), {1.6, 0.45, 1.9}, 3, 0.65);
  AddPlant(scene, shell.Wall(2, 7.7), 1.6);
  AddPlant(scene, shell.Wall(0, 2.9), 1.3);
  AddStack(scene, shell.Wall(0, 7.7));
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  ShellShape shell;
  shell.size = {kWidth, kDepth, kHeight + 0.2};
  shell.walls = {Finish{Material::kPlaster, 0.65},
                 {Material::kPaint, 0.6},
                 {Material::kPlaster, 0.6},
                 {Material::kPaint, 0.65}};
  shell.floor = {Material::kCarpet, 0.4};
  shell.ceiling = {Material::kPaint, 0.6};
  for (const double along : {0.7, 2.6, 4.5}) shell.openings[3].push_back({along, 1.4, 0.95, 1.6});
  AddShell(scene, shell);
  AddSkirting(scene, shell, {Material::kWood, 0.4});
  for (const Opening& hole : shell.openings[3]) {
    AddViewWindow(scene, shell.Wall(3), hole, {2, 1.6, 0.4, 6});
    AddRadiator(scene, shell.Wall(3, hole.along + 0.7), 1.2);
  }
  AddLamps(scene);
  Furnish(scene, shell);
  scene.SetAmbient(0.14);

  // Around the desks in the middle and through the passages, twice; looks ahead and into the room.
  const double x = 0.5 * kWidth + scene.Random(-0.1, 0.1);
  std::vector<Waypoint> way;
  for (int round = 0; round < 2; ++round) {
    const double drift = 0.15 * round;
    way.push_back({{x + 0.8, 1.6 + drift, 1.5}, 1.2, 0.12});
    way.push_back({{x + 1.0, 3.3, 1.55}, 1.9, 0.1});
    way.push_back({{x + 0.7, 4.9 - drift, 1.5}, 2.9, 0.12});
    way.push_back({{x - 0.9, 5.6, 1.5}, 3.9, 0.1});
    way.push_back({{0.95, 5.3, 1.5}, 4.9, 0.12});
    way.push_back({{0.85, 3.3, 1.45}, 5.6, 0.1});
    way.push_back({{0.95, 1.3, 1.5}, 6.5, 0.1});
    way.push_back({{x - 0.8, 0.95, 1.5}, 7.0, 0.12});
  }
  way.push_back(way.front());
  return {scene.Take(), WithCarrier(SplinePath(way, {0.75, 0.7}), Carrier::kHand, seed)};
}

}  // namespace lights

World MakeLights(std::uint64_t seed) { return lights::Make(seed); }

}  // namespace plumbline
