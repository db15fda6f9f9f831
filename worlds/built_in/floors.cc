// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace floors {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNorth = 0.5 * kPi, kSouth = -0.5 * kPi, kEast = 0, kWest = kPi;
constexpr double kWall = 0.14, kHeight = 2.7;

// Each of the two storeys: a corridor along the south, two rooms north of it, and in the west the
// well of the staircase, which both share.
//
//            | north-west room | north-east room |
//   stairs   |--   ------------------------   ---|
//            | corridor                          |
constexpr double kStorey = 3.2;  // from floor to floor
constexpr double kSouthEnd = 0.3, kCorridorEnd = 2.5, kRoomsBegin = kCorridorEnd + kWall;
constexpr double kNorthEnd = 7.6, kEastEnd = 17.4;
constexpr double kMiddle = 1.4;  // of the corridor, and of the door to the stairs

// The well. Nine steps lead west along its south side up to a landing at its end, nine back east
// along its north side to the upper storey.
constexpr double kWellLength = 5.4, kWellBreadth = 2.7;
constexpr double kLanding = 1.5, kTread = 0.3;
constexpr int kTreads = 8;  // of a flight, without the floor it ends on
constexpr double kRiser = 0.5 * kStorey / (kTreads + 1);
constexpr double kFlightEnd = kLanding + kTreads * kTread;
constexpr double kSlab = 0.2;
constexpr double kDoor = 0.9, kDoorHeight = 2.05;

// Parts of the plan that depend on the seed.
struct Plan {
  double party;      // western face of the wall between the rooms
  double west_door;  // middles of the doors to the corridor
  double east_door;
  double between;  // of the door from room to room
};

Plan MakePlan(SceneBuilder& random) {
  return {random.Random(10.8, 11.8),
          random.Random(7.1, 7.7),
          random.Random(15.4, 16.2),
          random.Random(4.3, 4.9)};
}

std::vector<RoomPlan> Rooms(const Plan& plan) {
  const double x = kWellLength + kWall;
  const auto room = [](const Vector2d& low, const Vector2d& high, Material floor, double tone) {
    return RoomPlan{low, high, kHeight, Material::kPaint, 0.68, floor, tone};
  };
  return {room({x, kSouthEnd}, {kEastEnd, kCorridorEnd}, Material::kTiles, 0.5),
          room({x, kRoomsBegin}, {plan.party, kNorthEnd}, Material::kFabric, 0.4),
          room({plan.party + kWall, kRoomsBegin}, {kEastEnd, kNorthEnd}, Material::kPlanks, 0.45)};
}

std::vector<Passage> Passages(const Plan& plan) {
  const double half = 0.5 * kDoor;
  return {{{kWellLength, kMiddle - half}, {kWellLength + kWall, kMiddle + half}, 0, kDoorHeight},
          {{plan.west_door - half, kCorridorEnd}, {plan.west_door + half, kRoomsBegin}},
          {{plan.east_door - half, kCorridorEnd}, {plan.east_door + half, kRoomsBegin}},
          {{plan.party, plan.between - half}, {plan.party + kWall, plan.between + half}}};
}

void FurnishWestRoom(SceneBuilder& scene, const Plan& plan) {
  const double x = kWellLength + kWall, breadth = plan.party - x;
  for (const double at : {x + 0.27 * breadth, x + 0.73 * breadth}) {
    AddWorkplace(scene, {{at, kNorthEnd - 0.03, 0}, kSouth}, 1.6, at < x + 0.5 * breadth ? 2 : 1);
    AddChair(scene, {{at + scene.Random(-0.2, 0.2), kNorthEnd - 1.3, 0}, kNorth});
    AddSheet(scene,
             {{at + scene.Random(-0.2, 0.2), kNorthEnd, 1.35}, kSouth},
             {scene.Random(0.7, 1.2), scene.Random(0.6, 0.9)},
             at < x + 0.5 * breadth ? Material::kMural : Material::kPoster,
             0.6);
  }
  AddShelf(scene, {{x, 5.9, 0}, kEast}, {1.6, 1.95, 0.34, 5, 0.9, 0.5});
  AddSheet(scene, {{x, 3.8, 1.2}, kEast}, {0.9, 0.7}, Material::kPoster, 0.8);
  AddCabinet(scene, {{plan.party - 1.2, kRoomsBegin, 0}, kNorth}, {1.4, 0.42, 1.1}, 3, 0.55);
  AddSheet(
      scene, {{plan.party - 1.2, kRoomsBegin, 1.4}, kNorth}, {1.0, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{plan.party, 6.3, 1.1}, kWest}, {0.8, 1.1}, Material::kPoster, 0.75);
  AddPlant(scene, {{plan.party - 0.4, kNorthEnd - 0.1, 0}, kSouth}, 1.6);
}

void FurnishEastRoom(SceneBuilder& scene, const Plan& plan) {
  const double x = plan.party + kWall, middle = 0.5 * (x + kEastEnd);
  AddShelf(scene, {{x + 1.3, kNorthEnd, 0}, kSouth}, {1.8, 1.95, 0.34, 5, 0.85, 0.5});
  TableShape table;
  table.length = 2.0;
  table.breadth = 0.9;
  const Place place{{middle + 0.9, kNorthEnd - 0.3, 0}, kSouth};
  AddTable(scene, place, table);
  AddClutter(scene, place, table, 6);
  AddChair(scene, {{middle + 0.5, kNorthEnd - 1.85, 0}, kNorth + scene.Random(-0.2, 0.2)});
  AddChair(scene, {{middle + 1.4, kNorthEnd - 1.85, 0}, kNorth + scene.Random(-0.2, 0.2)});
  AddSheet(scene, {{middle + 0.9, kNorthEnd, 1.2}, kSouth}, {1.6, 1.0}, Material::kMural, 0.5);
  AddCabinet(scene, {{kEastEnd, 5.9, 0}, kWest}, {1.4, 0.42, 1.2}, 2, 0.6);
  AddSheet(scene, {{kEastEnd, 5.9, 1.45}, kWest}, {1.2, 0.8}, Material::kPoster, 0.7);
  AddSheet(scene, {{kEastEnd, 3.9, 1.2}, kWest}, {0.8, 1.1}, Material::kPoster, 0.8);
  AddStack(scene, {{x + 0.5, kRoomsBegin + 0.05, 0}, kNorth});
  AddSheet(scene, {{x + 1.7, kRoomsBegin, 1.2}, kNorth}, {0.9, 0.7}, Material::kPoster, 0.8);
  AddSheet(scene, {{x, 6.4, 1.2}, kEast}, {0.7, 1.0}, Material::kPoster, 0.8);
}

void FurnishCorridor(SceneBuilder& scene, const Plan& plan) {
  for (const double x : {9.2, 13.6}) {
    AddDoor(scene, {{x, kSouthEnd, 0}, kNorth}, {0.9, 2.05, 2, 0.6});
    AddSheet(scene,
             {{x + scene.Random(1.3, 1.9), kSouthEnd, 1.15}, kNorth},
             {scene.Random(0.7, 1.1), scene.Random(0.6, 0.9)},
             Material::kPoster,
             0.75);
  }
  AddSheet(scene, {{6.9, kSouthEnd, 1.1}, kNorth}, {1.1, 0.8}, Material::kMural, 0.5);
  for (const double at : {0.25, 0.6}) {
    const double x = plan.west_door + at * (plan.east_door - plan.west_door);
    AddSheet(scene,
             {{x, kCorridorEnd, 1.1}, kSouth},
             {scene.Random(0.8, 1.3), scene.Random(0.7, 1.0)},
             at < 0.5 ? Material::kMural : Material::kPoster,
             0.6);
  }
  AddSheet(scene, {{kEastEnd, kMiddle, 1.1}, kWest}, {1.0, 0.8}, Material::kPoster, 0.75);
}

void AddLamps(SceneBuilder& scene, const std::vector<RoomPlan>& rooms) {
  for (const int column : {2, 7, 12, 17})
    AddGridLamp(scene, rooms[0].Ceiling(), {column, 1, 2, 1, 3});
  for (const std::size_t room : {1U, 2U}) {
    for (const int column : {2, 6}) {
      for (const int row : {2, 5})
        AddGridLamp(scene, rooms[room].Ceiling(), {column, row, 2, 1, 3});
    }
  }
}

// Parts common to both storeys, at the height of the lower one.
Scene MakeStorey(SceneBuilder& scene, const Plan& plan) {
  const std::vector<RoomPlan> rooms = Rooms(plan);
  AddBuilding(scene, rooms, Passages(plan));
  FurnishWestRoom(scene, plan);
  FurnishEastRoom(scene, plan);
  FurnishCorridor(scene, plan);
  AddLamps(scene, rooms);
  return scene.Take();
}

// With all its textures.
void AddStorey(const Scene& storey, double height, Scene& scene) {
  const Vector3d up = height * Vector3d::UnitZ();
  for (Surface surface : storey.surfaces) {
    surface.origin += up;
    scene.surfaces.push_back(surface);
  }
  for (const Segment3& edge : storey.edges) scene.edges.push_back({edge.start + up, edge.end + up});
  for (Lamp lamp : storey.lamps) {
    lamp.centre += up;
    scene.lamps.push_back(lamp);
  }
}

// The little by which storeys can be told apart.
void AddWhatDiffers(SceneBuilder& scene, const Plan& plan) {
  AddSheet(scene, {{16.7, kSouthEnd, 1.3}, kNorth}, {0.5, 0.4}, Material::kPoster, 0.85);
  AddSheet(
      scene, {{6.1, kCorridorEnd, kStorey + 1.4}, kSouth}, {0.35, 0.35}, Material::kPoster, 0.85);
  AddSheet(scene, {{plan.party, 3.3, kStorey + 1.3}, kWest}, {0.4, 0.5}, Material::kPoster, 0.8);
}

// The four sides of the well between two heights, with the door to the corridor.
void AddWellSides(SceneBuilder& scene, double bottom, double height) {
  const Vector3d base = bottom * Vector3d::UnitZ(), up = height * Vector3d::UnitZ();
  const Vector3d x = kWellLength * Vector3d::UnitX(), y = kWellBreadth * Vector3d::UnitY();
  const PanelLook look{Material::kPlaster, 0.6, false};
  const double door = kWellBreadth - kMiddle - 0.5 * kDoor;
  scene.AddFaceWithHoles(base + x, -x, up, {}, look);
  scene.AddFaceWithHoles(base + y, x, up, {}, look);
  scene.AddFaceWithHoles(base, y, up, {}, look);
  const std::vector<Opening> holes{{door, kDoor, 0, kDoorHeight}};
  scene.AddFaceWithHoles(base + x + y, -y, up, holes, look);
  AddDoorFrame(scene, {base + Vector3d(kWellLength, kMiddle, 0), kWest}, {kDoor, kDoorHeight});
}

void AddWell(SceneBuilder& scene) {
  const double top = kStorey + kHeight;
  AddWellSides(scene, 0, kStorey);
  AddWellSides(scene, kStorey, kHeight);
  scene.AddFloor(Vector3d::Zero(), {kWellLength, kWellBreadth}, Material::kTiles, 0.5);
  scene.AddCeiling({0, 0, top}, {kWellLength, kWellBreadth}, Material::kConcrete, 0.75);
  const Vector2d corners[] = {
      {0, 0}, {kWellLength, 0}, {kWellLength, kWellBreadth}, {0, kWellBreadth}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % 4];
    scene.AddEdge({a.x(), a.y(), 0}, {a.x(), a.y(), top});
    scene.AddEdge({a.x(), a.y(), top}, {b.x(), b.y(), top});
  }
}

void AddFlights(SceneBuilder& scene) {
  constexpr double kHalf = 0.5 * kWellBreadth;
  const auto solid = [&](double low_x, double high_x, double y, double breadth, double top) {
    scene.AddBox({{0.5 * (low_x + high_x), y, 0}, {high_x - low_x, breadth, top}, 0},
                 Material::kConcrete,
                 0.5);
  };
  for (int i = 0; i < kTreads; ++i) {
    const double first = kFlightEnd - (i + 1) * kTread, second = kLanding + i * kTread;
    const double rise = (i + 1) * kRiser;
    solid(first, first + kTread, 0.5 * kHalf, kHalf, rise);
    solid(second, second + kTread, 1.5 * kHalf, kHalf, 0.5 * kStorey + rise);
  }
  solid(0, kLanding, kHalf, kWellBreadth, 0.5 * kStorey);
  scene.AddBox({{0.5 * (kFlightEnd + kWellLength), kHalf, kStorey - kSlab},
                {kWellLength - kFlightEnd, kWellBreadth, kSlab},
                0},
               Material::kConcrete,
               0.55);
}

// Along the open sides of the upper flight and of the floor it ends on.
void AddRailing(SceneBuilder& scene) {
  constexpr double kRail = 0.95, kY = 0.5 * kWellBreadth + 0.05, kX = kFlightEnd + 0.05;
  const auto post = [&](double x, double y, double foot) {
    scene.AddBox({{x, y, foot}, {0.025, 0.025, kRail}, 0}, Material::kMetal, 0.3);
  };
  for (int i = 0; i < kTreads; ++i) {
    post(kLanding + (i + 0.5) * kTread, kY, 0.5 * kStorey + (i + 1) * kRiser);
  }
  for (int i = 0; i < 5; ++i) post(kX, 0.15 + 0.25 * i, kStorey);
  const double slope = kTreads * kRiser;
  scene.AddBar({kLanding + 0.05, kY, 0.5 * kStorey + kRail + 0.15},
               {kFlightEnd, kY, 0.5 * kStorey + slope + kRail + 0.15},
               0.05,
               Material::kWood,
               0.4);
  scene.AddBar({kX, 0.05, kStorey + kRail}, {kX, kY, kStorey + kRail}, 0.05, Material::kWood, 0.4);
}

void FurnishWell(SceneBuilder& scene) {
  const double landing = 0.5 * kStorey;
  AddSheet(scene, {{0, 0.7, landing + 1.1}, kEast}, {0.8, 1.0}, Material::kMural, 0.5);
  AddSheet(scene, {{0, 2.0, landing + 1.2}, kEast}, {0.7, 0.9}, Material::kPoster, 0.8);
  AddSheet(scene, {{2.7, 0, landing + 0.9}, kNorth}, {1.0, 0.8}, Material::kPoster, 0.7);
  AddSheet(scene, {{2.9, kWellBreadth, kStorey + 1.1}, kSouth}, {1.1, 0.8}, Material::kMural, 0.5);
  AddSheet(scene, {{4.65, kWellBreadth, 1.2}, kSouth}, {0.8, 0.6}, Material::kPoster, 0.8);
  AddSheet(scene, {{4.7, 0, kStorey + 1.2}, kNorth}, {0.8, 0.6}, Material::kPoster, 0.75);
  AddSheet(scene, {{kFlightEnd, 2.0, 1.2}, kEast}, {0.7, 0.9}, Material::kPoster, 0.8);
  const double top = kStorey + kHeight - 0.04;
  for (const double x : {1.2, 3.6}) scene.AddCeilingLamp({x, 1.35, top}, {0.9, 0.2}, 4);
  scene.AddCeilingLamp({4.65, 1.35, kStorey - kSlab - 0.01}, {0.2, 0.9}, 1.5);
}

// A leg and the height of the floor at its end.
struct Stretch {
  Vector2d to;
  double floor = 0;
  double pitch = 0.08;
};

// From the corridor through both rooms and back along the corridor to the door of the stairs.
void GoRound(const Plan& plan, double floor, SceneBuilder& random, std::vector<Stretch>& way) {
  const double x = plan.west_door, party = plan.party, between = plan.between;
  const auto aside = [&] { return random.Random(-0.08, 0.08); };
  for (const Vector2d& at : {Vector2d(x + 0.5 * aside(), kMiddle + aside()),
                             Vector2d(x + 0.5 * aside(), between + aside()),
                             Vector2d(party - 1.0, between + 0.5 * aside()),
                             Vector2d(party + 1.0, between + 0.5 * aside()),
                             Vector2d(plan.east_door + 0.5 * aside(), between + aside()),
                             Vector2d(plan.east_door + 0.5 * aside(), kMiddle + aside()),
                             Vector2d(0.5 * (x + plan.east_door), kMiddle + aside()),
                             Vector2d(6.4, kMiddle)}) {
    way.push_back({at, floor, random.Random(0.02, 0.14)});
  }
}

// Between the doors of the storeys.
void Climb(bool up, std::vector<Stretch>& way) {
  constexpr double kSouthSide = 0.25 * kWellBreadth, kNorthSide = 0.75 * kWellBreadth;
  constexpr double kTurn = 0.5 * kLanding, kFoot = kFlightEnd + 0.9;
  const double pitch = up ? -0.12 : 0.3;
  std::vector<Stretch> climb = {{{kFoot, kMiddle}, 0},
                                {{kFlightEnd, kSouthSide}, 0, pitch},
                                {{kLanding, kSouthSide}, 0.5 * kStorey, pitch},
                                {{kTurn, kSouthSide}, 0.5 * kStorey},
                                {{kTurn, kNorthSide}, 0.5 * kStorey},
                                {{kLanding, kNorthSide}, 0.5 * kStorey, pitch},
                                {{kFlightEnd, kNorthSide}, kStorey, pitch},
                                {{kFoot, kMiddle}, kStorey}};
  if (!up) std::reverse(climb.begin(), climb.end());
  way.insert(way.end(), climb.begin(), climb.end());
}

// The waypoints of a walk over a plan at the heights of its floors: before, in and after each
// corner (WalkAlong).
void Lift(std::vector<Waypoint>& waypoints,
          const Vector2d& start,
          const std::vector<Stretch>& way) {
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Vector2d from = i == 0 ? start : way[i - 1].to;
    const double floor_before = i == 0 ? way[0].floor : way[i - 1].floor;
    if (i + 1 == way.size()) {
      waypoints.back().position.z() += way[i].floor;
      break;
    }
    const auto share = [&](const Waypoint& at, const Vector2d& other) {
      return (at.position.head<2>() - way[i].to).norm() / (other - way[i].to).norm();
    };
    Waypoint* const corner = &waypoints[1 + 3 * i];
    const double here = way[i].floor;
    corner[0].position.z() += here + (floor_before - here) * share(corner[0], from);
    corner[1].position.z() += here;
    corner[2].position.z() += here + (way[i + 1].floor - here) * share(corner[2], way[i + 1].to);
  }
  waypoints.front().position.z() += way.front().floor;
}

// Round the lower storey, up, round the upper one, down, and the lower one again.
CameraPath Walk(const Plan& plan, SceneBuilder& random, std::uint64_t seed) {
  const Vector2d start(10.2, kMiddle);
  std::vector<Stretch> way;
  GoRound(plan, 0, random, way);
  Climb(true, way);
  way.push_back({{6.4, kMiddle}, kStorey});
  GoRound(plan, kStorey, random, way);
  Climb(false, way);
  way.push_back({{6.4, kMiddle}, 0});
  GoRound(plan, 0, random, way);
  way.pop_back();
  std::vector<Leg> legs;
  for (const Stretch& stretch : way) {
    legs.push_back({stretch.to, random.Random(-0.12, 0.12), stretch.pitch});
  }
  std::vector<Waypoint> waypoints = WalkAlong(start, legs, 1.5, 0.7);
  Lift(waypoints, start, way);
  return WithCarrier(SplinePath(waypoints, {1.0, 0.9}), Carrier::kHand, seed);
}

World Make(std::uint64_t seed) {
  SceneBuilder scene(seed);
  const Plan plan = MakePlan(scene);
  const Scene storey = MakeStorey(scene, plan);
  AddWell(scene);
  AddFlights(scene);
  AddRailing(scene);
  FurnishWell(scene);
  AddWhatDiffers(scene, plan);
  scene.SetAmbient(0.55);
  CameraPath path = Walk(plan, scene, seed);
  Scene all = scene.Take();
  AddStorey(storey, 0, all);
  AddStorey(storey, kStorey, all);
  return {std::move(all), std::move(path)};
}

}  // namespace floors

World MakeFloors(std::uint64_t seed) { return floors::Make(seed); }

}  // namespace plumbline
