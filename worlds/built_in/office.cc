// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/worlds.h"

#include <numbers>
#include <vector>

namespace plumbline {
namespace office {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNorth = 0.5 * kPi, kSouth = -0.5 * kPi, kEast = 0, kWest = kPi;
constexpr double kWall = 0.14, kNiche = 0.2, kHeight = 2.8;

// The open office, the meeting room and the kitchen east of it, the corridor north of both.
std::vector<RoomPlan> Rooms() {
  const auto room = [](const Vector2d& low, const Vector2d& high, Material floor, double tone) {
    return RoomPlan{low, high, kHeight, Material::kPaint, 0.7, floor, tone, 0.09, true};
  };
  return {room({0, 0}, {11, 8}, Material::kFabric, 0.35),
          room({11 + kWall, 0}, {16, 4.2}, Material::kFabric, 0.45),
          room({11 + kWall, 4.2 + kWall}, {16, 8}, Material::kTiles, 0.6),
          room({0, 8 + kWall}, {16, 10.2}, Material::kPlanks, 0.45)};
}

constexpr double kWindowFoot = 0.85, kWindowHeight = 1.45;
constexpr double kSouthWindows[] = {1.6, 4.1, 6.9, 9.4, 13.6};
constexpr double kWestWindows[] = {2.2, 4.7};

std::vector<Passage> Passages() {
  std::vector<Passage> passages = {{{2.0, 8}, {3.0, 8 + kWall}},
                                   {{9.0, 8}, {10.0, 8 + kWall}},
                                   {{11, 2.0}, {11 + kWall, 3.0}},
                                   {{11, 5.5}, {11 + kWall, 6.5}},
                                   {{13.0, 8}, {14.0, 8 + kWall}}};
  const double top = kWindowFoot + kWindowHeight;
  for (const double x : kSouthWindows) {
    passages.push_back({{x - 0.8, -kNiche}, {x + 0.8, 0}, kWindowFoot, top, false});
  }
  for (const double y : kWestWindows) {
    passages.push_back({{-kNiche, y - 0.7}, {0, y + 0.7}, kWindowFoot, top, false});
  }
  return passages;
}

void AddWindows(SceneBuilder& scene) {
  WindowShape window;
  window.height = kWindowHeight;
  window.recess = kNiche;
  window.power = 1.8;
  for (const double x : kSouthWindows) {
    window.breadth = 1.6;
    window.blinds = scene.Random(0, 1) < 0.5 ? scene.Random(0.15, 0.6) : 0;
    AddWindow(scene, {{x, -kNiche, kWindowFoot}, kNorth}, window);
    AddRadiator(scene, {{x, 0, 0}, kNorth}, 1.4);
  }
  window.breadth = 1.4;
  window.blinds = 0;
  for (const double y : kWestWindows) {
    AddWindow(scene, {{-kNiche, y, kWindowFoot}, kEast}, window);
    AddRadiator(scene, {{0, y, 0}, kEast}, 1.2);
  }
}

// Four workplaces back to back around a middle, with a partition and chairs.
void AddIsland(SceneBuilder& scene, const Vector2d& middle) {
  constexpr double kLength = 1.56, kGap = 0.03;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-0.5, 0.5}) {
      const double x = middle.x() + end * (kLength + 0.03), y = middle.y() + side * kGap;
      const double facing = side > 0 ? kNorth : kSouth;
      AddWorkplace(scene, {{x, y, 0}, facing}, kLength, scene.Random(0, 1) < 0.4 ? 2 : 1);
      const double chair_x = x + scene.Random(-0.2, 0.2);
      const double chair_y = y + side * scene.Random(1.28, 1.36);
      AddChair(scene, {{chair_x, chair_y, 0}, -facing + scene.Random(-0.2, 0.2)});
    }
  }
  scene.AddBox({{middle.x(), middle.y(), 0.4}, {2 * kLength, 0.035, 0.85}, 0},
               Material::kFabric,
               scene.Random(0.3, 0.6));
}

void FurnishOpenOffice(SceneBuilder& scene) {
  AddIsland(scene, {3.2, 3.0});
  AddIsland(scene, {8.2, 3.0});
  AddShelf(scene, {{4.7, 8, 0}, kSouth}, {2.4, 1.95, 0.34, 5, 0.9, 0.55});
  AddShelf(scene, {{0, 7.0, 0}, kEast}, {1.4, 1.4, 0.34, 3, 0.8, 0.5});
  AddWorkplace(scene, {{7.2, 7.97, 0}, kSouth}, 1.6, 2);
  AddChair(scene, {{7.3, 6.65, 0}, kNorth});
  AddCabinet(scene, {{11, 0.9, 0}, kWest}, {1.0, 0.42, 1.25}, 4, 0.6);
  AddCabinet(scene, {{11, 4.4, 0}, kWest}, {1.4, 0.42, 1.1}, 2, 0.5);
  scene.AddBox({{10.76, 4.3, 1.1}, {0.4, 0.5, 0.32}, 0}, Material::kPaint, 0.35);  // printer
  AddSheet(scene, {{8.4, 8, 1.15}, kSouth}, {0.9, 0.65}, Material::kPoster, 0.8);
  AddSheet(scene, {{6.4, 8, 1.3}, kSouth}, {0.5, 0.7}, Material::kPoster, 0.75);
  AddSheet(scene, {{1.2, 8, 1.2}, kSouth}, {0.8, 1.1}, Material::kPoster, 0.85);
  AddSheet(scene, {{11, 4.4, 1.6}, kWest}, {1.2, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{11, 7.3, 1.0}, kWest}, {0.8, 1.2}, Material::kPoster, 0.8);
  AddPlant(scene, {{0.35, 0.1, 0}, kNorth}, 1.5);
  AddPlant(scene, {{10.6, 7.9, 0}, kSouth}, 1.7);
  AddPlant(scene, {{8.45, 7.9, 0}, kSouth}, 1.0);
  for (const double x : {3.15, 8.85}) AddSocket(scene, {{x, 8, 1.05}, kSouth});
}

void FurnishMeetingRoom(SceneBuilder& scene) {
  TableShape table;
  table.length = 1.9;
  table.breadth = 1.0;
  const Place place{{15.4, 2.1, 0}, kWest};
  AddTable(scene, place, table);
  AddClutter(scene, place, table, 4);
  for (const double y : {1.5, 2.6}) {
    AddChair(scene, {{13.75 + scene.Random(-0.05, 0.05), y, 0}, kEast + scene.Random(-0.2, 0.2)});
  }
  AddSheet(scene, {{16, 2.1, 0.95}, kWest}, {2.0, 1.2}, Material::kScreen, 0.6);
  AddSheet(scene, {{13.2, 4.2, 0.9}, kSouth}, {1.8, 1.2}, Material::kBlank, 0.85);
  AddCabinet(scene, {{15.2, 4.2, 0}, kSouth}, {1.2, 0.42, 0.8}, 1, 0.55);
  AddSheet(scene, {{11 + kWall, 1.2, 1.1}, kEast}, {0.9, 1.2}, Material::kPoster, 0.8);
  AddSheet(scene, {{11 + kWall, 3.6, 1.4}, kEast}, {0.6, 0.45}, Material::kScreen, 0.5);
  AddPlant(scene, {{15.5, 0.1, 0}, kNorth}, 1.4);
}

void FurnishKitchen(SceneBuilder& scene) {
  // A kitchen unit with its worktop, cupboards above, a tap and things on it.
  AddCabinet(scene, {{16, 6.2, 0}, kWest}, {2.6, 0.58, 0.86}, 2, 0.7);
  scene.AddBox({{15.69, 6.2, 0.862}, {0.64, 2.66, 0.035}, 0}, Material::kWood, 0.45);
  AddCabinet(scene, {{16, 6.2, 1.45}, kWest}, {2.6, 0.34, 0.7}, 1, 0.7);
  TableShape top;
  top.length = 2.4;
  top.breadth = 0.5;
  top.height = 0.9;
  AddClutter(scene, {{15.95, 6.2, 0}, kWest}, top, 6);
  scene.AddBox({{15.65, 4.75, 0}, {0.62, 0.6, 1.75}, 0}, Material::kPaint, 0.8);  // refrigerator
  scene.AddBox({{15.32, 4.55, 1.0}, {0.03, 0.03, 0.4}, 0}, Material::kMetal, 0.3);
  TableShape table;
  table.length = 1.1;
  table.breadth = 0.7;
  AddTable(scene, {{13.4, 4.2 + kWall + 0.02, 0}, kNorth}, table);
  AddClutter(scene, {{13.4, 4.2 + kWall + 0.02, 0}, kNorth}, table, 3);
  AddSheet(scene, {{12.4, 8, 1.1}, kSouth}, {0.6, 0.8}, Material::kPoster, 0.8);
  AddSheet(scene, {{12.6, 4.2 + kWall, 1.2}, kNorth}, {0.7, 0.9}, Material::kPoster, 0.85);
}

void FurnishCorridor(SceneBuilder& scene) {
  for (const double x : {1.6, 6.1, 11.9}) {
    AddDoor(scene, {{x, 10.2, 0}, kSouth}, {0.95, 2.05, 0, 0.5});
    AddSheet(scene, {{x - 0.75, 10.2, 1.5}, kSouth}, {0.2, 0.14}, Material::kPoster, 0.85);
  }
  AddSheet(scene, {{3.9, 10.2, 1.0}, kSouth}, {1.5, 1.0}, Material::kPoster, 0.8);
  AddSheet(scene, {{8.7, 10.2, 1.1}, kSouth}, {1.3, 0.95}, Material::kMural, 0.5);
  AddSheet(scene, {{6.0, 8 + kWall, 1.1}, kNorth}, {1.4, 0.95}, Material::kPoster, 0.75);
  AddSheet(scene, {{11.6, 8 + kWall, 1.2}, kNorth}, {0.7, 0.95}, Material::kPoster, 0.8);
  AddSheet(scene, {{0, 9.2, 1.1}, kEast}, {0.9, 1.2}, Material::kPoster, 0.8);
  AddCabinet(scene, {{14.6, 10.2, 0}, kSouth}, {1.4, 0.4, 1.0}, 2, 0.5);
  AddPlant(scene, {{15.7, 8 + kWall + 0.05, 0}, kNorth}, 1.4);
}

void AddLamps(SceneBuilder& scene, const std::vector<RoomPlan>& rooms) {
  for (const int column : {2, 7, 12}) {
    for (const int row : {2, 6, 10}) AddGridLamp(scene, rooms[0].Ceiling(), {column, row, 2, 1, 3});
  }
  for (const int row : {1, 4}) {
    AddGridLamp(scene, rooms[1].Ceiling(), {3, row, 2, 1, 3});
    AddGridLamp(scene, rooms[2].Ceiling(), {3, row, 2, 1, 3});
  }
  for (const int column : {2, 8, 14, 19, 23}) {
    AddGridLamp(scene, rooms[3].Ceiling(), {column, 1, 2, 1, 2.8});
  }
}

CameraPath Walk(SceneBuilder& random, std::uint64_t seed) {
  std::vector<Leg> legs = {
      {{5.7, 5.3}},   {{1.0, 5.25}}, {{0.95, 0.8}}, {{10.25, 0.8}},  // around the desks
      {{10.25, 2.5}}, {{12.6, 2.5}}, {{12.6, 1.2}}, {{11.95, 1.2}},  // the meeting room
      {{11.95, 2.5}}, {{10.2, 2.5}}, {{10.2, 6.0}},                  // and out
      {{13.5, 6.0}},  {{13.5, 9.2}}, {{9.5, 9.2}},                   // kitchen, corridor
      {{9.5, 5.7}},   {{5.7, 5.6}},  {{5.7, 0.8}},  {{0.95, 0.8}},   // the desks again
      {{0.95, 5.3}},  {{2.5, 5.35}}, {{2.5, 9.15}}, {{9.5, 9.15}},   // the corridor again
      {{9.5, 5.5}},   {{5.7, 5.4}},  {{5.7, 0.8}},  {{10.25, 0.8}}, {{10.25, 4.2}}};  // as at first
  for (Leg& leg : legs) {
    leg.gaze = random.Random(-0.2, 0.2);
    leg.pitch = random.Random(0.02, 0.15);
  }
  return WithCarrier(
      SplinePath(WalkAlong({5.7, 0.9}, legs, 1.55, 0.8), {1.0, 0.9}), Carrier::kHand, seed);
}

// Another day: the rooms of the first walk in another order of lanes, a step aside, from a lower
// height and with another gaze. All of its views are near views of the first walk.
CameraPath SecondWalk(SceneBuilder& random, std::uint64_t seed) {
  std::vector<Leg> legs = {{{10.1, 2.35}},
                           {{12.45, 2.35}},
                           {{12.45, 1.35}},
                           {{12.1, 1.35}},  // the meeting room
                           {{12.1, 2.35}},
                           {{10.35, 2.35}},
                           {{10.35, 5.85}},  // and out
                           {{13.35, 5.85}},
                           {{13.35, 9.05}},
                           {{9.65, 9.05}},  // kitchen, corridor
                           {{9.65, 5.6}},
                           {{5.9, 5.45}},
                           {{1.15, 5.4}},
                           {{1.1, 0.7}},  // around the desks
                           {{5.5, 0.95}},
                           {{10.1, 0.95}},
                           {{10.1, 2.2}}};
  for (Leg& leg : legs) {
    leg.gaze = random.Random(-0.2, 0.2);
    leg.pitch = random.Random(0.0, 0.12);
  }
  return WithCarrier(
      SplinePath(WalkAlong({5.9, 0.95}, legs, 1.45, 0.8), {0.9, 0.8}), Carrier::kHand, seed + 1000);
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const std::vector<RoomPlan> rooms = Rooms();
  AddBuilding(scene, rooms, Passages());
  AddWindows(scene);
  FurnishOpenOffice(scene);
  FurnishMeetingRoom(scene);
  FurnishKitchen(scene);
  FurnishCorridor(scene);
  AddLamps(scene, rooms);
  scene.SetAmbient(0.55);
  CameraPath path = Walk(scene, seed);
  CameraPath second = SecondWalk(scene, seed);
  return {scene.Take(), std::move(path), std::move(second)};
}

}  // namespace office

World MakeOffice(std::uint64_t seed) { return office::Make(seed); }

}  // namespace plumbline
