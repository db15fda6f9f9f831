// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/fittings.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace tripod {

using Eigen::Vector3d;

constexpr double kWidth = 6.2, kDepth = 5.0, kHeight = 2.7;

// A study: shelves, a desk, a cupboard, pictures, a window with a view, a carpet.
void AddStudy(SceneBuilder& scene) {
  ShellShape shell;
  shell.size = {kWidth, kDepth, kHeight};
  shell.walls = {Finish{Material::kPlaster, 0.62},
                 {Material::kPaint, 0.6},
                 {Material::kPlaster, 0.6},
                 {Material::kPaint, 0.65}};
  shell.floor = {Material::kPlanks, 0.5};
  shell.ceiling = {Material::kPaint, 0.8};
  shell.openings[3].push_back({1.6, 1.8, 0.9, 1.3});
  AddShell(scene, shell);
  AddSkirting(scene, shell, {Material::kWood, 0.4});
  AddViewWindow(scene, shell.Wall(3), shell.openings[3].front(), {2, 4.5, 0.55, 5});
  AddRadiator(scene, shell.Wall(3, 2.5), 1.3);
  scene.AddBox({{0.5 * kWidth, 0.5 * kDepth, 0}, {2.4, 1.7, 0.012}, scene.Random(-0.2, 0.2)},
               Material::kCarpet,
               0.45);

  AddShelf(scene, shell.Wall(0, 1.2), {1.8, 1.95, 0.32, 5, 0.93, 0.45});
  AddDoor(scene, shell.Wall(0, 3.0), {});
  AddPicture(scene, shell.Wall(0, 4.1, 1.3), {0.7, 0.9}, Material::kPoster);
  AddCabinet(scene, shell.Wall(0, 5.3), {1.2, 0.45, 1.1}, 3, 0.6);
  AddThings(scene, {shell.Wall(0, 4.8).At(0, 0.2, 1.1), shell.Wall(0).facing}, 0.9, 0.32);

  const Place desk = shell.Wall(1, scene.Random(2.0, 2.6));
  AddWorkplace(scene, desk, 1.7, 2);
  AddChair(scene, {desk.At(0.1, 1.05, 0), desk.facing + std::numbers::pi + 0.3});
  AddPicture(scene, {desk.At(-0.6, 0, 1.4), desk.facing}, {0.9, 0.7}, Material::kMural);
  AddPicture(scene, {desk.At(0.5, 0, 1.45), desk.facing}, {0.5, 0.7}, Material::kPoster);
  AddPlant(scene, shell.Wall(1, 4.3), 1.5);

  AddShelf(scene, shell.Wall(2, 1.3), {1.4, 1.6, 0.32, 4, 0.9, 0.6});
  AddPicture(scene, shell.Wall(2, 2.7, 1.2), {0.8, 1.0}, Material::kPoster);
  AddTable(scene, shell.Wall(2, 4.4), {1.4, 0.6});
  AddClutter(scene, shell.Wall(2, 4.4), {1.4, 0.6}, 5);
  AddPicture(scene, shell.Wall(2, 4.4, 1.35), {1.2, 0.8}, Material::kPoster);
  AddStack(scene, shell.Wall(3, 0.6));
  AddStack(scene, shell.Wall(3, 4.4));
  AddSocket(scene, shell.Wall(0, 3.75, 1.1));
  AddSocket(scene, shell.Wall(2, 3.3, 0.3));
  for (const double x : {1.7, 4.5}) {
    AddTubeLamp(scene, {{x, 0.5 * kDepth, kHeight - 0.065}, 0}, {1.5, scene.Random(3.8, 4.4)});
  }
  scene.SetAmbient(0.25);
}

// One after the other; both must be at rest at the junction, at the same pose.
CameraPath Then(CameraPath first, CameraPath second) {
  const double switch_s = first.duration;
  return {switch_s + second.duration,
          [first = std::move(first), second = std::move(second), switch_s](double time) {
            return time < switch_s ? first.world_from_camera(time)
                                   : second.world_from_camera(time - switch_s);
          }};
}

// 0 before `start`, 1 after `start` + `span`, with continuous second derivative.
double Ramp(double time, double start, double span) {
  const double x = std::clamp((time - start) / span, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

// From the one path to the other between two times.
CameraPath Fade(CameraPath from, CameraPath to, double start, double span) {
  const double duration = from.duration;
  return {duration, [from = std::move(from), to = std::move(to), start, span](double time) {
            const Rigid3 a = from.world_from_camera(time), b = to.world_from_camera(time);
            const double share = Ramp(time, start, span);
            const Eigen::Vector3d turn = LogSo3(a.rotation.conjugate() * b.rotation);
            return Rigid3{(a.rotation * ExpSo3(share * turn)).normalized(),
                          a.translation + share * (b.translation - a.translation)};
          }};
}

// The camera turns on its tripod, exactly about its centre; then it is picked up and walked.
World MakeRotation(std::uint64_t seed) {
  SceneBuilder scene(seed);
  AddStudy(scene);
  const Vector3d stand(2.4 + scene.Random(-0.2, 0.2), 2.3 + scene.Random(-0.1, 0.1), 1.45);
  const double yaw = scene.Random(-0.3, 0.3);
  const auto look = [&](double turn, double pitch) {
    return Waypoint{stand, yaw + turn, pitch, 0, 0.4};
  };
  const CameraPath turning = SplinePath({look(0, 0.1),
                                         look(0.9, 0.15),
                                         look(1.7, 0.05),
                                         look(0.6, 0.3),
                                         look(-0.5, -0.05),
                                         look(-1.4, 0.1),
                                         look(0, 0.1)},
                                        {0.5, 0.5});
  const auto step = [&](double x, double y, double z, double turn) {
    return Waypoint{stand + Vector3d(x, y, z), yaw + turn, 0.1, 0};
  };
  const CameraPath walking = SplinePath({step(0, 0, 0, 0),
                                         step(0.2, -0.7, 0.05, 0.1),
                                         step(0.9, -0.5, 0.1, 0.3),
                                         step(1.1, 0.5, 0, -0.2),
                                         step(0.6, 0.9, -0.1, 0.5),
                                         step(-0.2, 0.8, 0, 1.2),
                                         step(-0.7, 0.2, 0.05, 1.8),
                                         step(-0.3, -0.6, 0, 1.0),
                                         step(0.5, -0.8, 0.1, 0.3),
                                         step(1.2, -0.3, 0.1, -0.3),
                                         step(1.2, 0.6, 0, -0.6),
                                         step(0.5, 0.9, 0, 0.1),
                                         step(-0.3, 0.3, 0.05, 0.3),
                                         step(0.4, -0.5, 0, 0.4)},
                                        {0.6, 0.6});
  const CameraPath still = Then(turning, walking);
  constexpr double kPickUp = 2;  // seconds
  return {scene.Take(),
          Fade(still, WithCarrier(still, Carrier::kHand, seed), turning.duration, kPickUp)};
}

// A tripod that gives by millimetres, and later a little more.
World MakeStatic(std::uint64_t seed) {
  constexpr double kDuration = 30, kFirst = 0.0012, kLater = 0.004, kLonger = 18;
  SceneBuilder scene(seed);
  AddStudy(scene);
  const Vector3d stand(1.3 + scene.Random(-0.1, 0.1), 2.6 + scene.Random(-0.2, 0.2), 1.4);
  const Eigen::Quaterniond attitude = CameraAttitude(scene.Random(-0.4, 0.4), 0.1, 0);
  // Per axis of translation and rotation: three sines.
  std::vector<std::pair<double, double>> waves;  // rad/s, phase
  for (int i = 0; i < 18; ++i) {
    waves.emplace_back(2 * std::numbers::pi * scene.Random(0.03, 0.1) * (1 + i % 3),
                       scene.Random(0, 2 * std::numbers::pi));
  }
  const auto at = [stand, attitude, waves](double time) {
    const double size = kFirst + (kLater - kFirst) * Ramp(time, kLonger, 4);
    Vector6d drift = Vector6d::Zero();
    for (std::size_t i = 0; i < waves.size(); ++i) {
      drift(static_cast<int>(i / 3)) += size / static_cast<double>(1 + i % 3) *
                                        math::Sin(waves[i].first * time + waves[i].second);
    }
    return Rigid3{(attitude * ExpSo3(0.7 * drift.tail<3>())).normalized(), stand + drift.head<3>()};
  };
  return {scene.Take(), {kDuration, at}};
}

}  // namespace tripod

World MakeRotation(std::uint64_t seed) { return tripod::MakeRotation(seed); }
World MakeStatic(std::uint64_t seed) { return tripod::MakeStatic(seed); }

}  // namespace plumbline
