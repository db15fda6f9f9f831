// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/elementary.h"
#include "worlds/built_in/floor_plan.h"
#include "worlds/built_in/shell.h"
#include "worlds/built_in/street.h"
#include "worlds/built_in/track.h"
#include "worlds/built_in/worlds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace plumbline {
namespace town {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kLane = 1.75;     // from the middle of the road to that of a lane
constexpr double kRoad = 5.6;      // half its breadth, with a row of parked cars on each side
constexpr double kPavement = 2.0;  // its breadth
constexpr double kFront = 9.5;     // from the middle of the road to the nearest houses
constexpr double kRowDepth = 12;   // from there to behind the last house of a row
constexpr double kOutside = 26;    // how far the ground goes on behind the outer streets
constexpr double kCameraHeight = 1.65;

// Two blocks side by side, and the streets around and between them:
//
//   d ---- e ---- f
//   |      |      |
//   a ---- b ---- c
struct Plan {
  Vector2d a, b, c, d, e, f;

  Plan(double middle, double east, double north)
      : a(0, 0), b(middle, 0), c(east, 0), d(0, north), e(middle, north), f(east, north) {}
};

// One side of a street, on the right when walking from one end to the other. In the frame of
// `place`, x is along the middle of the road and the houses have negative y.
struct StreetSide {
  Place place;
  double length = 0;
};

StreetSide RightSide(const Vector2d& from, const Vector2d& to) {
  const Vector2d way = to - from;
  return {{{from.x(), from.y(), 0}, math::Atan2(way.y(), way.x()) + 0.5 * kPi}, way.norm()};
}

// The corners of a rectangle, counterclockwise.
std::vector<Vector2d> Corners(const Vector2d& low, const Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

// The sides of streets that lie inside of the rectangle.
std::vector<StreetSide> InnerSides(const Vector2d& low, const Vector2d& high) {
  const std::vector<Vector2d> corners = Corners(low, high);
  std::vector<StreetSide> sides;
  for (std::size_t k = 0; k < 4; ++k) sides.push_back(RightSide(corners[(k + 1) % 4], corners[k]));
  return sides;
}

std::vector<StreetSide> OuterSides(const Vector2d& low, const Vector2d& high) {
  const std::vector<Vector2d> corners = Corners(low, high);
  std::vector<StreetSide> sides;
  for (std::size_t k = 0; k < 4; ++k) sides.push_back(RightSide(corners[k], corners[(k + 1) % 4]));
  return sides;
}

bool IsRoad(const Plan& plan, const Vector2d& at) {
  const auto is_at = [](double value, double road) { return std::abs(value - road) < kRoad; };
  const auto within = [](double value, double low, double high) {
    return value > low - kRoad && value < high + kRoad;
  };
  const bool along_x = is_at(at.y(), plan.a.y()) || is_at(at.y(), plan.d.y());
  const bool along_y =
      is_at(at.x(), plan.a.x()) || is_at(at.x(), plan.b.x()) || is_at(at.x(), plan.c.x());
  return (along_x && within(at.x(), plan.a.x(), plan.c.x())) ||
         (along_y && within(at.y(), plan.a.y(), plan.d.y()));
}

// Seams between the pieces of the ground along an axis: at the rims of the roads across it, and
// about 12 m apart.
std::vector<double> Cuts(std::span<const double> roads) {
  constexpr double kPiece = 12;
  std::vector<double> rims{roads.front() - kOutside};
  for (const double road : roads) rims.insert(rims.end(), {road - kRoad, road + kRoad});
  rims.push_back(roads.back() + kOutside);
  std::vector<double> cuts{rims.front()};
  for (std::size_t i = 0; i + 1 < rims.size(); ++i) {
    const double span = rims[i + 1] - rims[i];
    const int pieces = std::max(1, static_cast<int>(std::lround(span / kPiece)));
    for (int k = 1; k <= pieces; ++k) cuts.push_back(rims[i] + span * k / pieces);
  }
  return cuts;
}

// In pieces, so that only those close to the path have a fine texture.
void AddGround(SceneBuilder& scene, const Plan& plan) {
  const double across_x[] = {plan.a.x(), plan.b.x(), plan.c.x()};
  const double across_y[] = {plan.a.y(), plan.d.y()};
  const std::vector<double> xs = Cuts(across_x), ys = Cuts(across_y);
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    for (std::size_t k = 0; k + 1 < ys.size(); ++k) {
      const Vector2d low(xs[i], ys[k]), high(xs[i + 1], ys[k + 1]);
      const bool road = IsRoad(plan, 0.5 * (low + high));
      scene.AddFloor({low.x(), low.y(), 0},
                     high - low,
                     road ? Material::kPlaster : Material::kMural,
                     road ? scene.Random(0.27, 0.3) : scene.Random(0.22, 0.3));
    }
  }
}

// The broken line in the middle of a road.
void AddMarkings(SceneBuilder& scene, const StreetSide& side) {
  constexpr double kDash = 3, kGap = 4.5, kBroad = 0.14, kThick = 0.004;
  for (double x = kRoad + 1.5; x + kDash < side.length - kRoad; x += kDash + kGap) {
    scene.AddPanel(side.place.At(x, -0.5 * kBroad, kThick),
                   kDash * Along(side.place),
                   kBroad * Out(side.place),
                   {Material::kPaint, 0.7, true});
  }
}

void AddParkedCars(SceneBuilder& scene, const StreetSide& side) {
  constexpr double kFree = 13;  // of each crossing
  double x = kRoad + scene.Random(kFree, kFree + 6);
  while (x < side.length - kRoad - kFree) {
    AddCar(scene, {side.place.At(x, -kRoad + 1.05, 0), side.place.facing});
    x += scene.Random(5.6, 7) + (scene.Random(0, 1) < 0.55 ? scene.Random(4, 22) : 0);
  }
}

// Objects between the road and the houses: parked cars, the pavement, trees, lamps, hedges and
// fences. The pavement begins and ends `corner` from the rims of the crossings.
void AddKerbside(SceneBuilder& scene, const StreetSide& side, double corner) {
  constexpr double kKerb = 0.12;
  const Place& place = side.place;
  const double begin = kRoad + 0.5, end = side.length - kRoad - 0.5;
  const double behind = -kRoad - kPavement;
  AddPart(scene,
          place,
          {{0.5 * side.length, -kRoad - 0.5 * kPavement, 0},
           {side.length - 2 * (kRoad + corner), kPavement, kKerb}},
          Material::kConcrete,
          scene.Random(0.35, 0.45));
  AddParkedCars(scene, side);
  for (double x = begin + scene.Random(1, 9); x < end; x += scene.Random(9, 21)) {
    const Vector3d foot = place.At(x, behind - scene.Random(0.3, 0.6), 0);
    if (scene.Random(0, 1) < 0.7) {
      AddTree(scene, foot);
    } else {
      AddLampPost(scene, {foot, place.facing});
    }
  }
  for (double x = begin + scene.Random(3, 12); x + 8 < end; x += scene.Random(13, 24)) {
    const double length = scene.Random(3, 7);
    AddPart(scene,
            place,
            {{x + 0.5 * length, behind - 1.3, 0},
             {length, scene.Random(0.3, 0.6), scene.Random(0.7, 1.5)}},
            scene.Random(0, 1) < 0.6 ? Material::kMural : Material::kPlanks,
            scene.Random(0.2, 0.45));
  }
}

// Houses from `begin` to `end` along a street, some with a gap between, some farther back.
void AddRow(SceneBuilder& scene, const StreetSide& side, double begin, double end) {
  constexpr double kShortest = 7;
  double x = begin;
  while (end - x > kShortest) {
    HouseShape house;
    house.length = std::min(scene.Random(8.5, 15), end - x);
    if (end - x - house.length < kShortest) house.length = end - x;
    house.depth = scene.Random(7, 9);
    house.storeys = scene.Random(0, 1) < 0.35 ? 3 : 2;
    const double front = kFront + scene.Random(0, 2.5);
    AddHouse(scene, {side.place.At(x + 0.5 * house.length, -front, 0), side.place.facing}, house);
    x += house.length + (scene.Random(0, 1) < 0.4 ? scene.Random(1.5, 4) : 0.05);
  }
}

// Sides along x (the even ones of a rectangle) take the corners.
void AddHouses(SceneBuilder& scene, const Plan& plan) {
  for (const auto& block : {InnerSides(plan.a, plan.e), InnerSides(plan.b, plan.f)}) {
    for (std::size_t k = 0; k < block.size(); ++k) {
      const double corner = k % 2 == 0 ? kFront : kFront + kRowDepth;
      AddRow(scene, block[k], corner, block[k].length - corner);
    }
  }
  const std::vector<StreetSide> outer = OuterSides(plan.a, plan.f);
  for (std::size_t k = 0; k < outer.size(); ++k) {
    const double corner = k % 2 == 0 ? kFront + kRowDepth : kFront - 0.1;
    AddRow(scene, outer[k], -corner, outer[k].length + corner);
  }
}

// In the lane to the right of who goes from crossing to crossing.
CameraPath MakeRoute(const Plan& plan, SceneBuilder& scene) {
  constexpr double kCut = 9;  // distance before a crossing at which the turn begins
  constexpr double kBegin = 6;
  const Vector2d route[] = {plan.a,
                            plan.b,
                            plan.e,
                            plan.d,
                            plan.a,
                            plan.b,  // the first street again
                            plan.c,
                            plan.f,
                            plan.e,
                            plan.b,   // the other way than before
                            plan.c};  // and again
  const auto right_of = [](const Vector2d& way) {
    return (kLane * Vector2d(way.y(), -way.x()).normalized()).eval();
  };
  const std::size_t last = std::size(route) - 1;
  std::vector<Leg> legs;
  for (std::size_t i = 1; i <= last; ++i) {
    const Vector2d way = route[i] - route[i - 1];
    const Vector2d next = i < last ? (route[i + 1] - route[i]).eval() : way;
    const bool straight_on = way.normalized().dot(next.normalized()) > 0.5;
    Vector2d to = route[i] + right_of(way);
    if (i == last) to -= kRoad * way.normalized();
    if (!straight_on) to += right_of(next);
    legs.push_back({to, 0, scene.Random(-0.005, 0.005)});
  }
  const Vector2d first = (route[1] - route[0]).normalized();
  const Vector2d start = route[0] + right_of(first) + kBegin * first;
  return SplinePath(WalkAlong(start, legs, kCameraHeight, kCut), {10, 0.75});
}

// Cars that drive round both blocks in the lane that the camera never takes; none comes closer to
// it than in passing on adjacent lanes.
void AddTraffic(SceneBuilder& scene, const Plan& plan, const CameraPath& path) {
  constexpr int kCars = 4, kTries = 200;
  constexpr double kClosest = 2.9, kStep = 0.05;
  const Vector2d half = 0.5 * (plan.f - plan.a) - Vector2d(kLane, kLane);
  int cars = 0;
  for (int i = 0; i < kTries && cars < kCars; ++i) {
    const Track track{0.5 * (plan.a + plan.f), half, 6, -scene.Random(6, 9), scene.Random(0, 500)};
    bool clear = true;
    for (double time = 0; time < path.duration && clear; time += kStep) {
      const Vector3d apart = track.At(time).translation - path.world_from_camera(time).translation;
      clear = apart.head<2>().norm() > kClosest;
    }
    if (!clear) continue;
    ++cars;
    scene.BeginBody([track](double time) { return track.At(time); });
    AddCar(scene, {Vector3d::Zero(), 0.5 * kPi});
    scene.EndBody();
  }
}

// So far away that its light is the same everywhere.
void AddSun(SceneBuilder& scene) {
  constexpr double kFar = 3000, kPower = 0.8;
  const double azimuth = scene.Random(0, 2 * kPi), height = scene.Random(0.6, 1.0);
  const Vector3d towards(math::Cos(azimuth) * math::Cos(height),
                         math::Sin(azimuth) * math::Cos(height),
                         math::Sin(height));
  Lamp sun;
  sun.centre = kFar * towards;
  sun.power = kPower * kFar * kFar;
  scene.AddLamp(sun);
}

World Make(std::uint64_t seed) {
  constexpr double kCorner = 0.5;
  SceneBuilder scene(seed);
  const double middle = scene.Random(84, 96), north = scene.Random(66, 74);
  const Plan plan(middle, middle + scene.Random(84, 96), north);
  AddGround(scene, plan);
  for (const auto& block : {InnerSides(plan.a, plan.e), InnerSides(plan.b, plan.f)}) {
    for (std::size_t k = 0; k < block.size(); ++k) {
      AddKerbside(scene, block[k], k % 2 == 0 ? kCorner : kCorner + kPavement);
    }
  }
  for (const StreetSide& side : OuterSides(plan.a, plan.f)) AddKerbside(scene, side, kCorner);
  for (const StreetSide& side : InnerSides(plan.a, plan.e)) AddMarkings(scene, side);
  const Vector2d streets[][2] = {{plan.b, plan.c}, {plan.c, plan.f}, {plan.f, plan.e}};
  for (const auto& street : streets) AddMarkings(scene, RightSide(street[0], street[1]));
  AddHouses(scene, plan);
  AddSun(scene);
  scene.SetAmbient(0.7);
  const CameraPath path = WithCarrier(MakeRoute(plan, scene), Carrier::kCar, seed);
  AddTraffic(scene, plan, path);
  return {scene.Take(), path};
}

}  // namespace town

World MakeTown(std::uint64_t seed) { return town::Make(seed); }

}  // namespace plumbline
