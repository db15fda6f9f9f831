// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/worlds.h"

#include <array>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace low_texture {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNorth = 0.5 * kPi, kSouth = -0.5 * kPi, kEast = 0, kWest = kPi;
constexpr double kWall = 0.14, kLength = 16, kWidth = 2.2;
constexpr double kRoomLow = kWidth + kWall;  // the rooms lie north of the corridor

RoomPlan BlankRoom(const Vector2d& low, const Vector2d& high, double tone) {
  RoomPlan room;
  room.low = low;
  room.high = high;
  room.wall = Material::kBlank;
  room.wall_tone = tone;
  room.floor = Material::kBlank;
  room.floor_tone = 0.4;
  return room;
}

// Boards that keep carts off the wall, from x to x along the wall y = `wall`.
void AddGuard(SceneBuilder& scene, double from, double to, double wall) {
  const double facing = wall > 0 ? kSouth : kNorth;
  for (const double z : {0.25, 0.82}) {
    AddPart(scene,
            {{0.5 * (from + to), wall, z}, facing},
            {{0, 0.012, 0}, {to - from, 0.02, 0.16}},
            Material::kBlank,
            0.5);
  }
}

void FurnishCorridor(SceneBuilder& scene) {
  for (const double x : {2.1, 7.4, 12.9}) {
    AddDoor(scene, {{x, 0, 0}, kNorth}, {0.95, 2.05, 0, scene.Random(0.5, 0.65)});
    AddSheet(scene, {{x + 0.72, 0, 1.5}, kNorth}, {0.2, 0.12}, Material::kPaint, 0.9);
    AddSocket(scene, {{x + 0.72, 0, 1.05}, kNorth});
  }
  AddDoor(scene, {{kLength, 1.1, 0}, kWest}, {1.1, 2.1, 0, 0.55});
  AddSheet(scene, {{kLength, 1.1, 2.25}, kWest}, {0.4, 0.18}, Material::kPaint, 0.3);
  AddDoor(scene, {{8.2, kWidth, 0}, kSouth}, {0.95, 2.05, 0, scene.Random(0.5, 0.65)});
  AddDoor(scene, {{0, 1.1, 0}, kEast}, {1.1, 2.1, 0, 0.55});
  AddSheet(scene, {{8.2 + 0.72, kWidth, 1.5}, kSouth}, {0.2, 0.12}, Material::kPaint, 0.9);
  AddSocket(scene, {{9.1, kWidth, 0.55}, kSouth});
  AddSocket(scene, {{15.2, kWidth, 0.55}, kSouth});
  AddGuard(scene, 0.05, 1.45, 0);
  AddGuard(scene, 3.1, 4.1, 0);
  AddGuard(scene, 5.75, 6.7, 0);
  AddGuard(scene, 8.4, 9.2, 0);
  AddGuard(scene, 10.6, 12.25, 0);
  AddGuard(scene, 13.9, 15.95, 0);
  AddGuard(scene, 0.05, 2.85, kWidth);
  AddGuard(scene, 4.2, 7.4, kWidth);
  AddGuard(scene, 8.9, 11.25, kWidth);
  AddGuard(scene, 12.6, 15.95, kWidth);
  AddDuct(scene, {{5.0, 0, 2.35}, kNorth}, 4.2);
  // At the turn of the cart: without it no feature would be visible for a second.
  AddSheet(scene, {{13.9, kWidth, 1.1}, kSouth}, {0.6, 0.85}, Material::kPoster, 0.8);
  // A fire extinguisher in its bracket, a notice board, a bench.
  const double x = scene.Random(9.4, 10.4);
  scene.AddPrism({x, 0.12, 0.6}, {x, 0.12, 1.1}, {0.075, 8, 0}, Material::kPaint, 0.35);
  scene.AddBox({{x, 0.015, 0.75}, {0.04, 0.03, 0.25}, 0}, Material::kMetal, 0.4);
  AddSheet(scene, {{6.9, kWidth, 1.1}, kSouth}, {1.1, 0.8}, Material::kFabric, 0.5);
  TableShape bench;
  bench.length = 1.4;
  bench.breadth = 0.4;
  bench.height = 0.45;
  AddTable(scene, {{4.9, 0.02, 0}, kNorth}, bench);
}

// A meeting room: a table with chairs, a cupboard and a board, one window in the north.
void FurnishMeetingRoom(SceneBuilder& scene, const RoomPlan& room) {
  const Vector2d& low = room.low;
  const Vector2d& high = room.high;
  WindowShape window;
  window.breadth = 1.6;
  window.recess = kWall;
  window.power = 3;
  AddWindow(scene, {{3.4, high.y() + kWall, 0.9}, kSouth}, window);
  AddRadiator(scene, {{3.4, high.y(), 0}, kSouth}, 1.4);
  TableShape table;
  table.length = 1.5;
  table.tone = scene.Random(0.5, 0.7);
  const double x = low.x() + 0.15;
  AddTable(scene, {{x, 5.0, 0}, kEast}, table);
  AddChair(scene, {{x + 1.15, 4.7, 0}, kWest});
  AddSheet(scene, {{low.x(), 5.0, 1.0}, kEast}, {1.8, 1.1}, Material::kBlank, 0.9);
  AddCabinet(scene, {{high.x(), 6.2, 0}, kWest}, {1.2, 0.42, 1.1}, 1, 0.6);
  AddDuct(scene, {{high.x(), 3.9, 0.95}, kWest}, 2.9);
  AddDuct(scene, {{5.3, low.y(), 2.3}, kNorth}, 1.7);
  AddSheet(scene, {{5.2, low.y(), 1.1}, kNorth}, {0.9, 0.7}, Material::kFabric, 0.5);
  AddSocket(scene, {{high.x(), 5.7, 0.3}, kWest});
  AddSocket(scene, {{low.x(), 3.2, 1.05}, kEast});
}

// An office with two desks along the east wall and a cupboard.
void FurnishOffice(SceneBuilder& scene, const RoomPlan& room) {
  const Vector2d& low = room.low;
  const Vector2d& high = room.high;
  for (const double x : {10.6, 13.4}) {
    WindowShape window;
    window.recess = kWall;
    window.power = 2.5;
    window.blinds = x > 12 ? scene.Random(0.2, 0.5) : 0;
    AddWindow(scene, {{x, high.y() + kWall, 0.9}, kSouth}, window);
    AddRadiator(scene, {{x, high.y(), 0}, kSouth}, 1.2);
  }
  AddWorkplace(scene, {{high.x() - 0.05, 5.9, 0}, kWest}, 1.6, 1);
  AddChair(scene, {{high.x() - 1.15, 5.9, 0}, kEast});
  TableShape desk;
  AddTable(scene, {{high.x() - 0.05, 3.9, 0}, kWest}, desk);
  AddCabinet(scene, {{low.x(), 6.4, 0}, kEast}, {1.4, 0.42, 1.9}, 2, 0.55);
  AddSheet(scene, {{low.x(), 3.9, 1.3}, kEast}, {0.7, 1.0}, Material::kPoster, 0.8);
  AddSocket(scene, {{low.x(), 5.2, 0.3}, kEast});
  AddDuct(scene, {{low.x(), 3.9, 0.95}, kEast}, 2.8);
  AddDuct(scene, {{high.x(), 5.0, 1.2}, kWest}, 4.4);
  AddSheet(scene, {{10.2, low.y(), 1.0}, kNorth}, {1.2, 0.9}, Material::kBlank, 0.85);
  AddSheet(scene, {{14.2, low.y(), 1.3}, kNorth}, {0.5, 0.7}, Material::kPaint, 0.9);
}

void AddLamps(SceneBuilder& scene, const std::vector<RoomPlan>& rooms) {
  for (const int column : {1, 6, 11, 15, 19, 23}) {
    AddGridLamp(scene, rooms[0].Ceiling(), {column, 1, 2, 1, 3});
  }
  for (const RoomPlan* room : {&rooms[1], &rooms[2]}) {
    for (const int column : {2, 6}) {
      for (const int row : {1, 5}) {
        AddGridLamp(scene, room->Ceiling(), {column, row, 1, 2, 3});
      }
    }
  }
}

// Another day: the same rooms, a step aside, from a lower height and with a gaze of its own.
CameraPath SecondDrive(SceneBuilder& random, std::uint64_t seed) {
  std::vector<Leg> legs = {{{3.7, 1.25}},
                           {{3.7, 4.8}},  // the meeting room
                           {{4.55, 4.8}},
                           {{4.55, 3.75}},
                           {{3.45, 3.7}},
                           {{3.45, 1.2}},  // and out
                           {{11.8, 1.2}},
                           {{11.8, 4.95}, 0.15},  // the office
                           {{10.85, 5.0}},
                           {{10.85, 4.05}},
                           {{11.8, 3.95}},
                           {{11.8, 1.15}},
                           {{14.1, 1.1}},
                           {{14.15, 1.35}},
                           {{2.2, 1.35}}};
  for (Leg& leg : legs) {
    leg.gaze += random.Random(-0.1, 0.1);
    leg.pitch = random.Random(-0.1, -0.03);
  }
  return WithCarrier(SplinePath(WalkAlong({1.4, 1.25}, legs, 1.05, 0.8), {0.8, 0.55}, 0.6),
                     Carrier::kWheels,
                     seed + 1000);
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const double tone = scene.Random(0.66, 0.76);
  const std::vector<RoomPlan> rooms = {BlankRoom({0, 0}, {kLength, kWidth}, tone),
                                       BlankRoom({1, kRoomLow}, {6.4, 7.4}, tone - 0.03),
                                       BlankRoom({9, kRoomLow}, {15.2, 7.6}, tone + 0.02)};
  const std::vector<Passage> passages = {{{3.0, kWidth}, {4.05, kRoomLow}},
                                         {{11.4, kWidth}, {12.45, kRoomLow}},
                                         {{2.6, 7.4}, {4.2, 7.4 + kWall}, 0.9, 2.2, false},
                                         {{9.9, 7.6}, {11.3, 7.6 + kWall}, 0.9, 2.2, false},
                                         {{12.7, 7.6}, {14.1, 7.6 + kWall}, 0.9, 2.2, false}};
  AddBuilding(scene, rooms, passages);
  FurnishCorridor(scene);
  FurnishMeetingRoom(scene, rooms[1]);
  FurnishOffice(scene, rooms[2]);
  AddLamps(scene, rooms);
  AddOpenLeaf(scene, {{3.0 + 0.03, kRoomLow + 0.03, 0}, kNorth}, {1.0, 2.05, 0, 0.55});
  AddOpenLeaf(scene, {{12.45 - 0.03, kRoomLow + 0.03, 0}, kNorth}, {1.0, 2.05, 0, 0.55});
  scene.SetAmbient(0.5);
  const double a = scene.Random(-0.1, 0.1), b = scene.Random(-0.1, 0.1);
  std::vector<Leg> legs = {
      {{3.55, 1.1 + a}},     // along the corridor
      {{3.6, 5.0 + a}},      // into the meeting room
      {{4.7 + b, 5.0 + a}},  // a turn in it
      {{4.7 + b, 3.6}},
      {{3.57, 3.55}},
      {{3.52, 1.1}},  // out
      {{11.92, 1.1 + b}},
      {{11.9, 5.1 + b}, 0.2},  // into the office
      {{10.7 + a, 5.2 + b}},
      {{10.7 + a, 3.9}},
      {{11.9, 3.8}},
      {{11.92, 1.0}},
      {{14.3, 0.95 + 0.5 * a}},  // to the far end and back
      {{14.35, 1.3}},
      {{1.9, 1.25 + a}},
  };
  for (Leg& leg : legs) leg.pitch = -0.07;  // the ceiling is the richest there is
  const auto walk = WalkAlong({1.2, 1.1}, legs, 1.15, 0.8);
  CameraPath path = WithCarrier(SplinePath(walk, {0.9, 0.55}, 0.6), Carrier::kWheels, seed);
  CameraPath second = SecondDrive(scene, seed);
  return {scene.Take(), std::move(path), std::move(second)};
}

}  // namespace low_texture

World MakeLowTexture(std::uint64_t seed) { return low_texture::Make(seed); }

}  // namespace plumbline
