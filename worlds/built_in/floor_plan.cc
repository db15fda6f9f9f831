// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/built_in/floor_plan.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumbline {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kClose = 1e-6;
constexpr double kPi = std::numbers::pi;

// One side of a room, seen from inside: it runs to the right from its start.
struct Side {
  Vector3d start;
  Vector3d along;  // unit vector
  Vector3d front;  // unit vector, into the room
  double length = 0;
  std::vector<Opening> openings;
  std::vector<bool> frames;  // of each opening
};

// Sides in the order south, east, north, west. Seen from inside, walls run to the right: south from
// east to west.
Side MakeSide(const RoomPlan& room, int index) {
  const Vector2d size = room.high - room.low;
  const Vector3d corners[4] = {{room.low.x(), room.low.y(), 0},
                               {room.high.x(), room.low.y(), 0},
                               {room.high.x(), room.high.y(), 0},
                               {room.low.x(), room.high.y(), 0}};
  const Vector3d fronts[4] = {
      Vector3d::UnitY(), -Vector3d::UnitX(), -Vector3d::UnitY(), Vector3d::UnitX()};
  Side side;
  side.start = corners[(index + 1) % 4];
  side.front = fronts[index];
  side.along = Vector3d::UnitZ().cross(side.front);
  side.length = index % 2 == 0 ? size.x() : size.y();
  return side;
}

void AddOpenings(Side& side, std::span<const Passage> passages) {
  struct Hole {
    Opening opening;
    bool frame;
  };
  std::vector<Hole> holes;
  for (const Passage& passage : passages) {
    const Vector3d a(passage.low.x(), passage.low.y(), 0);
    const Vector3d b(passage.high.x(), passage.high.y(), 0);
    const double behind =
        std::max((a - side.start).dot(side.front), (b - side.start).dot(side.front));
    if (std::abs(behind) > kClose) continue;
    const double u = (a - side.start).dot(side.along), v = (b - side.start).dot(side.along);
    const double left = std::min(u, v), right = std::max(u, v);
    if (left < -kClose || right > side.length + kClose || right - left < kClose) continue;
    holes.push_back(
        {{left, right - left, passage.bottom, passage.top - passage.bottom}, passage.frame});
  }
  std::sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) {
    return a.opening.along < b.opening.along;
  });
  for (const Hole& hole : holes) {
    side.openings.push_back(hole.opening);
    side.frames.push_back(hole.frame);
  }
}

bool ReachesCeiling(const Opening& hole, double height) {
  return hole.bottom + hole.height > height - kClose;
}

// Calls `use` with the ends of each piece of the side that no hole of a kind takes away.
template <typename Taken, typename Use>
void ForRest(const Side& side, Taken&& taken, Use&& use) {
  double left = 0;
  for (const Opening& hole : side.openings) {
    if (!taken(hole)) continue;
    if (hole.along - left > kClose) use(left, hole.along);
    left = hole.along + hole.width;
  }
  if (side.length - left > kClose) use(left, side.length);
}

void AddSideEdges(SceneBuilder& scene, const Side& side, double height) {
  const auto at = [&side](double along, double z) -> Vector3d {
    return side.start + along * side.along + z * Vector3d::UnitZ();
  };
  ForRest(
      side,
      [](const Opening& hole) { return hole.bottom < kClose; },
      [&](double a, double b) { scene.AddEdge(at(a, 0), at(b, 0)); });
  ForRest(
      side,
      [height](const Opening& hole) { return ReachesCeiling(hole, height); },
      [&](double a, double b) { scene.AddEdge(at(a, height), at(b, height)); });
  for (const Opening& hole : side.openings) {
    const double left = hole.along, right = hole.along + hole.width;
    const double top = hole.bottom + hole.height;
    if (left > kClose) scene.AddEdge(at(left, hole.bottom), at(left, top));
    if (right < side.length - kClose) scene.AddEdge(at(right, hole.bottom), at(right, top));
    if (!ReachesCeiling(hole, height)) scene.AddEdge(at(left, top), at(right, top));
    if (hole.bottom > kClose) scene.AddEdge(at(left, hole.bottom), at(right, hole.bottom));
  }
}

// Returns true if a hole as tall as the room begins (ends) at the end of the side: no corner there.
bool OpenAt(const Side& side, bool start, double height) {
  return std::any_of(side.openings.begin(), side.openings.end(), [&](const Opening& hole) {
    const bool touches =
        start ? hole.along < kClose : hole.along + hole.width > side.length - kClose;
    return touches && hole.bottom < kClose && ReachesCeiling(hole, height);
  });
}

void AddSkirting(SceneBuilder& scene, const Side& side, const RoomPlan& room, int index) {
  constexpr double kThick = 0.013, kStep = 0.002, kHidden = 0.005;
  const double height = room.skirting - (index % 2 == 0 ? 0 : kStep);  // they cross in the corners
  ForRest(
      side,
      [](const Opening& hole) { return hole.bottom < kClose; },
      [&](double left, double right) {
        // Its ends beside holes are hidden in the door frame, not flush with it.
        const double a = left > kClose ? left + kHidden : left;
        const double b = right < side.length - kClose ? right - kHidden : right;
        const Vector3d middle = side.start + 0.5 * (a + b) * side.along;
        scene.AddBox({middle + 0.5 * kThick * side.front,
                      {b - a, kThick, height},
                      math::Atan2(side.along.y(), side.along.x())},
                     Material::kBlank,
                     0.35);
      });
}

void AddRoomSide(SceneBuilder& scene, const Side& side, const RoomPlan& room, int index) {
  const Vector3d up = room.height * Vector3d::UnitZ();
  scene.AddFaceWithHoles(
      side.start, side.length * side.along, up, side.openings, {room.wall, room.wall_tone});
  AddSideEdges(scene, side, room.height);
  if (room.skirting > 0) AddSkirting(scene, side, room, index);
  const double facing = math::Atan2(side.front.y(), side.front.x());
  for (std::size_t i = 0; i < side.openings.size(); ++i) {
    if (!side.frames[i]) continue;
    const Opening& hole = side.openings[i];
    const Vector3d foot = side.start + (hole.along + 0.5 * hole.width) * side.along;
    AddDoorFrame(scene, {foot, facing}, {hole.width, hole.height});
  }
}

// The faces inside a hole and the edges across the wall. A hole is wider than deep.
void AddReveals(SceneBuilder& scene, const Passage& passage) {
  const Vector2d size = passage.high - passage.low;
  if (size.minCoeff() < kClose) return;
  const bool through_y = size.y() < size.x();
  const Vector3d corner(passage.low.x(), passage.low.y(), passage.bottom);
  const Vector3d x = size.x() * Vector3d::UnitX(), y = size.y() * Vector3d::UnitY();
  const Vector3d up = (passage.top - passage.bottom) * Vector3d::UnitZ();
  const Vector3d wide = through_y ? x : y, deep = through_y ? y : x;
  const PanelLook look{Material::kBlank, 0.6, false};
  // Each is lit on the side of the hole.
  const Vector3d first = through_y ? corner : corner + wide;
  const Vector3d second = through_y ? corner + wide : corner;
  scene.AddPanel(first, deep, up, look);
  scene.AddPanel(second + deep, -deep, up, look);
  scene.AddPanel(corner + up, y, x, look);
  scene.AddPanel(corner, x, y, {Material::kWood, 0.4, false});
  for (const Vector3d& side : {Vector3d::Zero().eval(), wide}) {
    scene.AddEdge(corner + side, corner + side + deep);
    scene.AddEdge(corner + side + up, corner + side + up + deep);
  }
}

}  // namespace

CeilingGrid RoomPlan::Ceiling() const {
  return {{low.x(), low.y(), height}, high - low, 0.6, 0.75};
}

void AddBuilding(SceneBuilder& scene,
                 std::span<const RoomPlan> rooms,
                 std::span<const Passage> passages) {
  for (const RoomPlan& room : rooms) {
    const Vector3d corner(room.low.x(), room.low.y(), 0);
    scene.AddFloor(corner, room.high - room.low, room.floor, room.floor_tone);
    if (room.grid) {
      AddCeilingGrid(scene, room.Ceiling());
    } else {
      scene.AddCeiling(
          corner + room.height * Vector3d::UnitZ(), room.high - room.low, Material::kBlank, 0.8);
    }
    std::array<Side, 4> sides;
    for (int i = 0; i < 4; ++i) {
      sides[static_cast<std::size_t>(i)] = MakeSide(room, i);
      AddOpenings(sides[static_cast<std::size_t>(i)], passages);
    }
    for (int i = 0; i < 4; ++i) {
      const Side& side = sides[static_cast<std::size_t>(i)];
      AddRoomSide(scene, side, room, i);
      // The start of a side is the end of the one before it, seen from inside.
      const Side& other = sides[static_cast<std::size_t>((i + 1) % 4)];
      if (!OpenAt(side, true, room.height) && !OpenAt(other, false, room.height)) {
        scene.AddEdge(side.start, side.start + room.height * Vector3d::UnitZ());
      }
    }
  }
  for (const Passage& passage : passages) AddReveals(scene, passage);
}

std::vector<Waypoint> WalkAlong(const Vector2d& start,
                                std::span<const Leg> legs,
                                double height,
                                double radius) {
  std::vector<Waypoint> waypoints;
  const auto add = [&](const Vector2d& at, double yaw, double pitch) {
    waypoints.push_back({{at.x(), at.y(), height}, yaw, pitch});
  };
  Vector2d from = start;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    const Vector2d way = leg.to - from;
    const double yaw = math::Atan2(way.y(), way.x()) + leg.gaze;
    if (i == 0) add(start, yaw, leg.pitch);
    if (i + 1 == legs.size()) {
      add(leg.to, yaw, leg.pitch);
      break;
    }
    const Leg& next = legs[i + 1];
    const Vector2d onward = next.to - leg.to;
    const double next_yaw = math::Atan2(onward.y(), onward.x()) + next.gaze;
    const double cut = std::min({radius, 0.45 * way.norm(), 0.45 * onward.norm()});
    const Vector2d before = leg.to - cut * way.normalized();
    const Vector2d after = leg.to + cut * onward.normalized();
    add(before, yaw, leg.pitch);
    add(0.25 * (before + 2 * leg.to + after),
        yaw + 0.5 * std::remainder(next_yaw - yaw, 2 * kPi),
        0.5 * (leg.pitch + next.pitch));
    add(after, next_yaw, next.pitch);
    from = leg.to;
  }
  return waypoints;
}

}  // namespace plumbline
