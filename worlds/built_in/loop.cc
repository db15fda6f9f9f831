// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/worlds.h"

#include <numbers>
#include <vector>

namespace plumbline {
namespace loop {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNorth = 0.5 * kPi, kSouth = -0.5 * kPi, kEast = 0, kWest = kPi;
constexpr double kWall = 0.14;

// Four rooms in the corners of a rectangle, joined by four corridors into a ring:
//
//   library ---- lockers ---- lounge
//      |                         |
//   windows                    pipes
//      |                         |
//   workshop --- pictures --- office
constexpr double kEnd = 26, kTop = 15.4;  // outer size
constexpr double kRoomX = 6, kRoomY = 5.4;

struct Ring {
  RoomPlan workshop, office, lounge, library;
  RoomPlan pictures, pipes, lockers, windows;

  std::vector<RoomPlan> All() const {
    return {workshop, office, lounge, library, pictures, pipes, lockers, windows};
  }
};

Ring MakeRing() {
  const double x = kRoomX, y = kRoomY, far_x = kEnd - x, far_y = kTop - y;
  Ring ring;
  ring.workshop = {{0, 0}, {x, y}, 3.2, Material::kBrick, 0.5, Material::kConcrete, 0.45, 0, false};
  ring.office = {{far_x, 0}, {kEnd, y}, 2.7, Material::kPaint, 0.7, Material::kFabric, 0.4};
  ring.lounge = {{far_x, far_y}, {kEnd, kTop}, 2.9, Material::kPaint, 0.6, Material::kPlanks, 0.5};
  ring.lounge.grid = false;
  ring.library = {{0, far_y}, {x, kTop}, 3.0, Material::kPaint, 0.55, Material::kPlanks, 0.4};
  ring.pictures = {{x + kWall, 1.4}, {far_x - kWall, 3.8}, 2.6, Material::kPaint, 0.65};
  ring.pictures.floor = Material::kCarpet;
  ring.pipes = {{22.0, y + kWall}, {24.2, far_y - kWall}, 2.9, Material::kConcrete, 0.55};
  ring.pipes.floor = Material::kTiles;
  ring.pipes.floor_tone = 0.55;
  ring.pipes.grid = false;
  ring.lockers = {{x + kWall, 11.6}, {far_x - kWall, 13.9}, 2.7, Material::kBlank, 0.7};
  ring.lockers.floor = Material::kTiles;
  ring.lockers.floor_tone = 0.5;
  ring.windows = {{1.6, y + kWall}, {3.9, far_y - kWall}, 2.8, Material::kPaint, 0.65};
  ring.windows.floor = Material::kPlanks;
  ring.windows.floor_tone = 0.45;
  return ring;
}

constexpr double kWindowFoot = 0.8, kWindowTop = 2.2;

std::vector<Passage> MakePassages() {
  const double x = kRoomX, y = kRoomY, far_x = kEnd - x, far_y = kTop - y;
  const double s = 2.6, e = 23.1, n = 12.75, w = 2.75, half = 0.6;  // middles of the corridors
  std::vector<Passage> passages = {
      {{x, s - half}, {x + kWall, s + half}},
      {{far_x - kWall, s - half}, {far_x, s + half}},
      {{e - half, y}, {e + half, y + kWall}},
      {{e - half, far_y - kWall}, {e + half, far_y}},
      {{x, n - half}, {x + kWall, n + half}},
      {{far_x - kWall, n - half}, {far_x, n + half}},
      {{w - half, y}, {w + half, y + kWall}},
      {{w - half, far_y - kWall}, {w + half, far_y}},
  };
  for (const double at : {6.3, 8.6}) {  // the corridor of windows
    passages.push_back({{1.6 - kWall, at - 0.6}, {1.6, at + 0.6}, kWindowFoot, kWindowTop, false});
  }
  for (const double at : {21.6, 24.4}) {  // the office
    passages.push_back({{at - 0.7, -kWall}, {at + 0.7, 0}, kWindowFoot, kWindowTop, false});
  }
  for (const double at : {21.8, 24.2}) {  // the lounge
    passages.push_back(
        {{at - 0.7, kTop}, {at + 0.7, kTop + kWall}, kWindowFoot, kWindowTop, false});
  }
  passages.push_back({{-kWall, 1.6}, {0, 3.2}, kWindowFoot, kWindowTop, false});  // the workshop
  return passages;
}

void AddWindows(SceneBuilder& scene) {
  WindowShape window;
  window.height = kWindowTop - kWindowFoot;
  window.recess = kWall;
  window.breadth = 1.2;
  window.power = 2;
  for (const double y : {6.3, 8.6}) {
    AddWindow(scene, {{1.6 - kWall, y, kWindowFoot}, kEast}, window);
    AddRadiator(scene, {{1.6, y, 0}, kEast}, 1.0);
  }
  window.power = 3;
  window.breadth = 1.4;
  window.blinds = 0.35;
  for (const double x : {21.6, 24.4}) AddWindow(scene, {{x, -kWall, kWindowFoot}, kNorth}, window);
  window.blinds = 0;
  for (const double x : {21.8, 24.2}) {
    AddWindow(scene, {{x, kTop + kWall, kWindowFoot}, kSouth}, window);
    AddRadiator(scene, {{x, kTop, 0}, kSouth}, 1.2);
  }
  window.breadth = 1.6;
  window.bars = 3;
  AddWindow(scene, {{-kWall, 2.4, kWindowFoot}, kEast}, window);
}

void FurnishWorkshop(SceneBuilder& scene) {
  TableShape bench;
  bench.length = 2.0;
  bench.height = 0.88;
  const Place middle{{3.0, 1.75, 0}, kNorth};  // one walks around this one
  bench.breadth = 0.9;
  AddTable(scene, middle, bench);
  AddClutter(scene, middle, bench, 5);
  bench.breadth = 0.6;
  const Place wall{{3.0, 0.03, 0}, kNorth};
  AddTable(scene, wall, bench);
  AddClutter(scene, wall, bench, 6);
  AddShelf(scene, {{0, 4.4, 0}, kEast}, {1.6, 2.0, 0.4, 4, 0.6, 0.4});
  for (const double x : {4.9, 5.55}) {
    scene.AddPrism({x, 0.45, 0}, {x, 0.45, 0.88}, {0.29, 12, 0.02}, Material::kMetal, 0.5);
  }
  AddStack(scene, {{5.2, 5.3, 0}, kSouth});
  AddStack(scene, {{4.5, 5.35, 0}, kSouth});
  AddSheet(scene, {{3.0, 0, 1.2}, kNorth}, {2.2, 0.9}, Material::kWood, 0.55);  // tool board
  for (int i = 0; i < 7; ++i) {
    const double x = 2.1 + 0.28 * i;
    scene.AddBox({{x, 0.035, scene.Random(1.3, 1.6)}, {0.04, 0.025, scene.Random(0.2, 0.42)}, 0},
                 Material::kMetal,
                 scene.Random(0.15, 0.6));
  }
  for (const double y : {1.2, 2.6, 4.0}) {
    scene.AddBox({{3.0, y, 3.0}, {5.98, 0.12, 0.196}, 0}, Material::kWood, 0.4);
  }
  scene.AddPrism({0.1, 5.25, 2.6}, {5.9, 5.25, 2.6}, {0.07, 8, 0}, Material::kPaint, 0.6);
  for (const double x : {1.7, 4.3}) {
    for (const double y : {1.9, 3.5}) {
      scene.AddBox({{x, y, 2.9}, {1.3, 0.16, 0.08}, 0}, Material::kPaint, 0.8);
      scene.AddCeilingLamp({x, y, 2.89}, {1.26, 0.12}, 4);
    }
  }
}

void FurnishOffice(SceneBuilder& scene) {
  const double x = kEnd - kRoomX;
  AddWorkplace(scene, {{22.2, 2.68, 0}, kSouth}, 1.56, 2);
  AddWorkplace(scene, {{22.2, 2.72, 0}, kNorth}, 1.56, 1);
  AddChair(scene, {{22.2, 1.25, 0}, kNorth});
  AddShelf(scene, {{kEnd, 1.5, 0}, kWest}, {2.0, 1.95, 0.34, 5, 0.9, 0.6});
  AddCabinet(scene, {{kEnd, 3.9, 0}, kWest}, {1.5, 0.42, 1.2}, 3, 0.6);
  AddCabinet(scene, {{x, 4.6, 0}, kEast}, {1.2, 0.42, 1.0}, 2, 0.5);
  AddSheet(scene, {{x, 4.6, 1.25}, kEast}, {0.9, 0.7}, Material::kPoster, 0.75);
  AddSheet(scene, {{21.5, kRoomY, 1.0}, kSouth}, {1.5, 1.1}, Material::kBlank, 0.85);
  AddSheet(scene, {{25.2, kRoomY, 1.2}, kSouth}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddSheet(scene, {{kEnd, 3.9, 1.5}, kWest}, {1.2, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{x, 0.8, 1.2}, kEast}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddPlant(scene, {{20.4, 0.1, 0}, kNorth}, 1.5);
}

void FurnishLounge(SceneBuilder& scene) {
  const double x = kEnd - kRoomX, y = kTop - kRoomY;
  const auto sofa = [&scene](const Place& place, double length, double tone) {
    AddPart(scene, place, {{0, 0.48, 0.06}, {length, 0.9, 0.36}}, Material::kFabric, tone);
    AddPart(scene, place, {{0, 0.12, 0.42}, {length, 0.22, 0.42}}, Material::kFabric, tone);
    for (const double end : {-0.5, 0.5}) {
      AddPart(scene,
              place,
              {{end * (length - 0.2), 0.58, 0.42}, {0.2, 0.68, 0.2}},
              Material::kFabric,
              0.9 * tone);
    }
  };
  sofa({{kEnd - 0.02, 12.2, 0}, kWest}, 2.0, 0.35);
  sofa({{22.9, kTop - 0.2, 0}, kSouth}, 1.9, 0.5);
  scene.AddBox({{22.6, 12.5, 0}, {2.6, 2.0, 0.012}, 0.05}, Material::kCarpet, 0.4);
  TableShape table;  // one walks around this one
  table.length = 1.1;
  table.breadth = 0.7;
  table.height = 0.45;
  AddTable(scene, {{22.4, 12.2, 0.012}, kNorth}, table);
  AddClutter(scene, {{22.4, 12.2, 0.012}, kNorth}, table, 3);
  AddShelf(scene, {{x, 11.0, 0}, kEast}, {1.4, 1.2, 0.34, 3, 0.8, 0.6});
  AddSheet(scene, {{x, 11.0, 1.4}, kEast}, {1.2, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{kEnd, 12.2, 1.1}, kWest}, {1.5, 1.0}, Material::kMural, 0.5);
  AddSheet(scene, {{kEnd, 14.4, 1.2}, kWest}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddSheet(scene, {{25.1, y, 1.2}, kNorth}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddSheet(scene, {{21.1, y, 1.2}, kNorth}, {0.9, 0.7}, Material::kPoster, 0.8);
  AddPlant(scene, {{20.4, kTop - 0.1, 0}, kSouth}, 1.8);
  AddPlant(scene, {{25.6, kTop - 0.1, 0}, kSouth}, 1.5);
  for (const double at : {21.5, 24.5}) {
    for (const double to : {11.4, 13.8}) {
      scene.AddBox({{at, to, 2.8}, {0.64, 0.64, 0.06}, 0}, Material::kPaint, 0.8);
      scene.AddPrism({at, to, 2.86}, {at, to, 2.9}, {0.02, 6, 0}, Material::kMetal, 0.4);
      scene.AddCeilingLamp({at, to, 2.79}, {0.6, 0.6}, 3.5);
    }
  }
}

void FurnishLibrary(SceneBuilder& scene) {
  const double y = kTop - kRoomY;
  const ShelfShape tall{2.4, 2.3, 0.34, 5, 0.8, 0.45};
  AddShelf(scene, {{1.5, kTop, 0}, kSouth}, tall);
  AddShelf(scene, {{4.3, kTop, 0}, kSouth}, tall);
  AddShelf(scene, {{0, 12.9, 0}, kEast}, {2.6, 2.3, 0.34, 5, 0.8, 0.45});
  AddShelf(scene, {{4.8, y, 0}, kNorth}, {1.8, 1.2, 0.34, 3, 0.9, 0.45});
  AddShelf(scene, {{3.1, 13.02, 0}, kNorth}, {1.6, 1.3, 0.3, 3, 0.8, 0.5});  // one walks around
  AddShelf(scene, {{3.1, 12.98, 0}, kSouth}, {1.6, 1.3, 0.3, 3, 0.8, 0.5});
  AddSheet(scene, {{4.8, y, 1.4}, kNorth}, {1.3, 0.9}, Material::kMural, 0.5);
  AddSheet(scene, {{kRoomX, 14.6, 1.2}, kWest}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddSheet(scene, {{kRoomX, 11.2, 1.2}, kWest}, {0.8, 1.1}, Material::kPoster, 0.75);
  AddChair(scene, {{0.4, 10.5, 0}, kEast});
}

void FurnishCorridors(SceneBuilder& scene) {
  // Pictures along the south, a door now and then.
  for (int i = 0; i < 5; ++i) {
    const double x = 7.6 + 2.6 * i + scene.Random(-0.2, 0.2);
    const Vector2d size(scene.Random(0.6, 1.2), scene.Random(0.6, 1.0));
    AddSheet(scene,
             {{x, 1.4, 1.15}, kNorth},
             size,
             i % 2 == 0 ? Material::kMural : Material::kPoster,
             0.55);
    if (i % 2 == 0) {
      AddDoor(scene, {{x + 1.4, 3.8, 0}, kSouth}, {0.9, 2.05, 2, 0.6});
    } else {
      AddSheet(scene, {{x + 1.4, 3.8, 1.2}, kSouth}, {0.8, 1.0}, Material::kPoster, 0.75);
    }
  }
  // Pipes along the east.
  for (int i = 0; i < 3; ++i) {
    const double x = 22.25 + 0.16 * i, z = 2.62 - 0.07 * i;
    scene.AddPrism({x, kRoomY + kWall, z},
                   {x, kTop - kRoomY - kWall, z},
                   {0.045 + 0.01 * i, 8, 0},
                   Material::kPaint,
                   0.45 + 0.12 * i);
  }
  scene.AddBox({{23.9, 7.7, 2.5}, {0.3, 4.2, 0.1}, 0}, Material::kMetal, 0.5);  // cable tray
  AddCabinet(scene, {{24.2, 7.2, 0.5}, kWest}, {0.8, 0.25, 1.1}, 1, 0.5);
  AddSheet(scene, {{22.0, 8.2, 1.2}, kEast}, {0.7, 1.0}, Material::kPoster, 0.8);
  AddStack(scene, {{24.05, 9.4, 0}, kWest});
  // Lockers and benches along the north.
  for (int i = 0; i < 4; ++i) {
    AddCabinet(scene, {{7.7 + 3.1 * i, 13.9, 0}, kSouth}, {2.2, 0.4, 1.85}, 2, 0.4 + 0.08 * i);
    AddSheet(scene,
             {{8.1 + 3.0 * i, 11.6, 1.15}, kNorth},
             {scene.Random(0.6, 1.0), scene.Random(0.7, 1.0)},
             Material::kPoster,
             0.8);
  }
  TableShape bench;
  bench.length = 1.6;
  bench.breadth = 0.35;
  bench.height = 0.45;
  for (const double x : {9.7, 15.6}) AddTable(scene, {{x, 11.62, 0}, kNorth}, bench);
  // Opposite the windows of the west.
  AddSheet(scene, {{3.9, 6.6, 1.1}, kWest}, {1.1, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{3.9, 8.8, 1.2}, kWest}, {0.7, 1.0}, Material::kPoster, 0.8);
  AddPlant(scene, {{3.85, 7.6, 0}, kWest}, 1.4);
}

void AddGridLamps(SceneBuilder& scene, const Ring& ring) {
  for (const int column : {2, 7, 12, 17, 21}) {
    AddGridLamp(scene, ring.pictures.Ceiling(), {column, 1, 2, 1, 3});
    AddGridLamp(scene, ring.lockers.Ceiling(), {column, 1, 2, 1, 3});
  }
  for (const RoomPlan* room : {&ring.office, &ring.library}) {
    for (const int column : {2, 6}) {
      for (const int row : {2, 6}) AddGridLamp(scene, room->Ceiling(), {column, row, 2, 1, 3.5});
    }
  }
  AddGridLamp(scene, ring.windows.Ceiling(), {1, 1, 1, 2, 2.5});
  AddGridLamp(scene, ring.windows.Ceiling(), {1, 5, 1, 2, 2.5});
  for (const double y : {6.8, 8.8}) {
    scene.AddBox({{23.1, y, 2.86}, {0.16, 1.3, 0.038}, 0}, Material::kPaint, 0.8);
    scene.AddCeilingLamp({23.1, y, 2.85}, {0.12, 1.26}, 3);
  }
}

CameraPath TwoRounds(SceneBuilder& random, std::uint64_t seed) {
  // In each room the path goes around the objects in its middle.
  const std::vector<Vector2d> round = {{5.0, 2.5},
                                       {20.6, 2.6},
                                       {20.7, 4.3},
                                       {23.1, 4.3},  // to the office
                                       {23.1, 11.4},
                                       {21.2, 11.5},
                                       {21.2, 12.7},  // to the lounge
                                       {5.0, 12.8},
                                       {4.6, 14.1},
                                       {1.5, 14.0},
                                       {1.5, 11.6},  // to the library
                                       {2.75, 11.2},
                                       {2.75, 4.4},
                                       {1.1, 3.4},
                                       {1.2, 1.25},  // to the workshop
                                       {5.0, 1.2}};
  std::vector<Leg> legs;
  for (int lap = 0; lap < 2; ++lap) {
    for (const Vector2d& at : round) {
      const Vector2d shift(random.Random(-0.1, 0.1), random.Random(-0.1, 0.1));
      legs.push_back({at + shift, random.Random(-0.15, 0.15), random.Random(0.02, 0.14)});
    }
  }
  legs.push_back({{5.0, 2.5}});
  legs.push_back({{8.5, 2.6}});  // revisits the start
  return WithCarrier(
      SplinePath(WalkAlong({4.9, 1.3}, legs, 1.55, 0.8), {1.15, 0.9}), Carrier::kHand, seed);
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const Ring ring = MakeRing();
  AddBuilding(scene, ring.All(), MakePassages());
  AddWindows(scene);
  FurnishWorkshop(scene);
  FurnishOffice(scene);
  FurnishLounge(scene);
  FurnishLibrary(scene);
  FurnishCorridors(scene);
  AddGridLamps(scene, ring);
  scene.SetAmbient(0.55);
  CameraPath path = TwoRounds(scene, seed);
  return {scene.Take(), std::move(path)};
}

}  // namespace loop

World MakeLoop(std::uint64_t seed) { return loop::Make(seed); }

}  // namespace plumbline
