// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/world_file.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/cameras/yaml_section.h"
#include "worlds/scene_builder.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::uint64_t kLargestWorld = std::uint64_t{16} << 20;  // bytes of a file
constexpr double kFarthest = 1e4;    // metres from the origin, for every number of a place
constexpr double kSmallest = 1e-4;   // metres, for every side of a thing
constexpr double kLongest = 86400;   // seconds from the first waypoint to the last
constexpr double kOffNormal = 1e-6;  // cosine between sides that are to be normal to each other

double Within(const YamlSection& section, const std::string& key, double low, double high) {
  const double value = section.Number(key);
  if (!(value >= low && value <= high)) {
    section.Fail(key,
                 fmt::format("expected a number from {:g} to {:g}, found {:g}", low, high, value));
  }
  return value;
}

double WithinOr(
    const YamlSection& section, const std::string& key, double low, double high, double otherwise) {
  return section.Has(key) ? Within(section, key, low, high) : otherwise;
}

double Length(const YamlSection& section, const std::string& key) {
  return Within(section, key, kSmallest, kFarthest);
}

// Numbers of a place or a size, each within the limits.
template <int kCount>
Eigen::Matrix<double, kCount, 1> Numbers(const YamlSection& section,
                                         const std::string& key,
                                         double low) {
  const std::vector<double> numbers = section.Numbers(key, {kCount});
  for (const double number : numbers) {
    if (!(number >= low && number <= kFarthest)) {
      section.Fail(
          key,
          fmt::format("expected numbers from {:g} to {:g}, found {:g}", low, kFarthest, number));
    }
  }
  return Eigen::Map<const Eigen::Matrix<double, kCount, 1>>(numbers.data());
}

Vector3d PlaceOf(const YamlSection& section, const std::string& key) {
  return Numbers<3>(section, key, -kFarthest);
}

template <class Enum>
Enum ChoiceOf(const YamlSection& section, const std::string& key) {
  const std::string text = section.Text(key);
  std::string names;
  for (const auto& [value, name] : EnumNames(std::type_identity<Enum>{})) {
    if (text == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  section.Fail(key, "expected one of " + names + ", found " + InQuotes(text));
}

struct Look {
  Material material;
  double tone;
};

// The keys of a look, and those that a shape has beside them.
const std::vector<std::string> kLookKeys = {"shape", "material", "tone"};

void Allow(const YamlSection& section, std::vector<std::string> keys) {
  keys.insert(keys.end(), kLookKeys.begin(), kLookKeys.end());
  section.RejectUnknown(keys);
}

Look LookOf(const YamlSection& section) {
  return {ChoiceOf<Material>(section, "material"), WithinOr(section, "tone", 0, 1, 0.5)};
}

// From one place to another, which must not be the same.
std::pair<Vector3d, Vector3d> EndsOf(const YamlSection& section) {
  const Vector3d from = PlaceOf(section, "from"), to = PlaceOf(section, "to");
  if ((to - from).norm() < kSmallest) section.Fail("to", "expected another place than from");
  return {from, to};
}

void AddBox(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"base", "size", "yaw_deg", "glow"});
  const Look look = LookOf(section);
  scene.AddBox({PlaceOf(section, "base"),
                Numbers<3>(section, "size", kSmallest),
                kRadians * WithinOr(section, "yaw_deg", -360, 360, 0)},
               look.material,
               look.tone,
               WithinOr(section, "glow", 0, 100, 0));
}

void AddBar(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"from", "to", "thickness"});
  const Look look = LookOf(section);
  const auto [from, to] = EndsOf(section);
  scene.AddBar(from, to, Length(section, "thickness"), look.material, look.tone);
}

void AddPrism(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"from", "to", "radius", "sides"});
  const Look look = LookOf(section);
  const auto [from, to] = EndsOf(section);
  PrismShape shape;
  shape.radius = Length(section, "radius");
  const double sides = WithinOr(section, "sides", 4, 64, 12);
  shape.sides = static_cast<int>(sides);
  if (shape.sides != sides || shape.sides % 2 != 0) {
    section.Fail("sides", fmt::format("expected an even number, found {:g}", sides));
  }
  scene.AddPrism(from, to, shape, look.material, look.tone);
}

void AddPanel(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"corner", "u", "v", "edges", "glow"});
  const Look look = LookOf(section);
  const Vector3d u = PlaceOf(section, "u"), v = PlaceOf(section, "v");
  for (const auto& [key, side] : {std::pair{"u", u}, std::pair{"v", v}}) {
    if (side.norm() < kSmallest) section.Fail(key, "expected a side that is not 0");
  }
  if (std::abs(u.dot(v)) > kOffNormal * u.norm() * v.norm()) {
    section.Fail("v", "expected a side normal to u");
  }
  scene.AddPanel(PlaceOf(section, "corner"),
                 u,
                 v,
                 {look.material,
                  look.tone,
                  !section.Has("edges") || section.Bool("edges"),
                  WithinOr(section, "glow", 0, 100, 0)});
}

// Holes as AddWall asks for them: inside the wall, in order, apart from each other.
std::vector<Opening> OpeningsOf(const YamlSection& section, double length, double height) {
  std::vector<Opening> openings;
  if (!section.Has("openings")) return openings;
  double free_from = 0;
  for (const YamlSection& item : section.Items("openings")) {
    item.RejectUnknown({"along", "width", "bottom", "height"});
    Opening hole;
    hole.along = Within(item, "along", free_from, length);
    hole.width = Within(item, "width", kSmallest, length - hole.along);
    hole.bottom = WithinOr(item, "bottom", 0, height, 0);
    hole.height = Within(item, "height", kSmallest, height - hole.bottom);
    free_from = hole.along + hole.width;
    openings.push_back(hole);
  }
  return openings;
}

void AddWall(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"from", "to", "height", "thickness", "openings"});
  const Look look = LookOf(section);
  WallShape wall;
  std::tie(wall.start, wall.end) = EndsOf(section);
  if (wall.start.z() != wall.end.z()) section.Fail("to", "expected a place as high as from");
  wall.height = Length(section, "height");
  wall.thickness = section.Has("thickness") ? Length(section, "thickness") : wall.thickness;
  const auto openings = OpeningsOf(section, (wall.end - wall.start).norm(), wall.height);
  scene.AddWall(wall, openings, look.material, look.tone);
}

void AddFloor(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"corner", "size"});
  const Look look = LookOf(section);
  scene.AddFloor(
      PlaceOf(section, "corner"), Numbers<2>(section, "size", kSmallest), look.material, look.tone);
}

void AddCeiling(const YamlSection& section, SceneBuilder& scene) {
  Allow(section, {"corner", "size"});
  const Look look = LookOf(section);
  scene.AddCeiling(
      PlaceOf(section, "corner"), Numbers<2>(section, "size", kSmallest), look.material, look.tone);
}

void AddRoom(const YamlSection& section, SceneBuilder& scene) {
  section.RejectUnknown({"shape", "size", "wall", "floor"});
  scene.AddRoom(Numbers<3>(section, "size", kSmallest),
                ChoiceOf<Material>(section, "wall"),
                ChoiceOf<Material>(section, "floor"));
}

struct ShapeKind {
  std::string_view name;
  void (*add)(const YamlSection& section, SceneBuilder& scene);
};
constexpr std::array kShapes = {ShapeKind{"room", AddRoom},
                                ShapeKind{"box", AddBox},
                                ShapeKind{"wall", AddWall},
                                ShapeKind{"floor", AddFloor},
                                ShapeKind{"ceiling", AddCeiling},
                                ShapeKind{"panel", AddPanel},
                                ShapeKind{"bar", AddBar},
                                ShapeKind{"prism", AddPrism}};

void AddShape(const YamlSection& section, SceneBuilder& scene) {
  const std::string name = section.Text("shape");
  std::string names;
  for (const ShapeKind& kind : kShapes) {
    if (name == kind.name) return kind.add(section, scene);
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  }
  section.Fail("shape", "expected one of " + names + ", found " + InQuotes(name));
}

void AddLamp(const YamlSection& section, SceneBuilder& scene) {
  section.RejectUnknown({"centre", "size", "u", "v", "power"});
  const Vector3d centre = PlaceOf(section, "centre");
  const double power = Within(section, "power", 0, 1e4);
  if (section.Has("size")) {
    for (const char* key : {"u", "v"}) {
      if (section.Has(key)) section.Fail(key, "expected either size (a ceiling lamp) or u and v");
    }
    scene.AddCeilingLamp(centre, Numbers<2>(section, "size", kSmallest), power);
    return;
  }
  Lamp lamp;
  lamp.centre = centre;
  lamp.power = power;
  if (section.Has("u") || section.Has("v")) {
    lamp.side_u = PlaceOf(section, "u");
    lamp.side_v = PlaceOf(section, "v");
  }
  scene.AddLamp(lamp);
}

// A body goes to and fro along `shift` in `period_s`, and turns about the vertical through `pivot`.
void AddBody(const YamlSection& section, SceneBuilder& scene) {
  section.RejectUnknown({"pivot", "shift", "period_s", "turn_deg_per_s", "shapes"});
  const Vector3d pivot = PlaceOf(section, "pivot");
  const Vector3d shift = section.Has("shift") ? PlaceOf(section, "shift") : Vector3d::Zero().eval();
  const double rate = 2 * std::numbers::pi / WithinOr(section, "period_s", 0.1, 1e4, 4);
  const double turn = kRadians * WithinOr(section, "turn_deg_per_s", -1000, 1000, 0);
  scene.BeginBody([=](double time) {
    return Rigid3{ExpSo3({0, 0, turn * time}), pivot + 0.5 * (1 - math::Cos(rate * time)) * shift};
  });
  for (const YamlSection& shape : section.Items("shapes")) AddShape(shape, scene);
  scene.EndBody();
}

constexpr std::array kCarriers = {std::pair{"tripod", Carrier::kTripod},
                                  std::pair{"hand", Carrier::kHand},
                                  std::pair{"drone", Carrier::kDrone},
                                  std::pair{"wheels", Carrier::kWheels},
                                  std::pair{"car", Carrier::kCar}};

Carrier CarrierOf(const YamlSection& section) {
  if (!section.Has("carrier")) return Carrier::kTripod;
  const std::string text = section.Text("carrier");
  for (const auto& [name, carrier] : kCarriers) {
    if (text == name) return carrier;
  }
  section.Fail("carrier", "expected tripod, hand, drone, wheels or car, found " + InQuotes(text));
}

CameraPath PathOf(const YamlSection& section, std::uint64_t seed) {
  section.RejectUnknown({"carrier", "speed", "turn_rate", "waypoints"});
  std::vector<Waypoint> waypoints;
  double way = 0;
  for (const YamlSection& item : section.Items("waypoints")) {
    item.RejectUnknown({"at", "yaw_deg", "pitch_deg", "roll_deg", "pause_s"});
    Waypoint waypoint;
    waypoint.position = PlaceOf(item, "at");
    waypoint.yaw = kRadians * WithinOr(item, "yaw_deg", -360, 360, 0);
    waypoint.pitch = kRadians * WithinOr(item, "pitch_deg", -89, 89, 0);
    waypoint.roll = kRadians * WithinOr(item, "roll_deg", -180, 180, 0);
    waypoint.pause = WithinOr(item, "pause_s", 0, 3600, 0);
    if (!waypoints.empty()) way += (waypoint.position - waypoints.back().position).norm();
    way += waypoint.pause;
    waypoints.push_back(waypoint);
  }
  if (waypoints.size() < 2) {
    section.Fail("waypoints", fmt::format("expected 2 or more, found {}", waypoints.size()));
  }
  if (way == 0) section.Fail("waypoints", "expected places apart from each other, or a pause");
  const Pace pace{WithinOr(section, "speed", 0.01, 100, 1),
                  WithinOr(section, "turn_rate", 0.01, 20, 1)};
  if (way / pace.speed > kLongest) {
    section.Fail(
        "waypoints",
        fmt::format("expected a way of at most {:g} s, found more at this speed", kLongest));
  }
  return WithCarrier(SplinePath(waypoints, pace), CarrierOf(section), seed);
}

World MakeFromFile(const YamlSection& root, std::uint64_t seed) {
  SceneBuilder scene(seed);
  for (const YamlSection& shape : root.Items("shapes")) AddShape(shape, scene);
  if (root.Has("lamps")) {
    for (const YamlSection& lamp : root.Items("lamps")) AddLamp(lamp, scene);
  }
  if (root.Has("bodies")) {
    for (const YamlSection& body : root.Items("bodies")) AddBody(body, scene);
  }
  scene.SetAmbient(WithinOr(root, "ambient", 0, 100, 0.3));
  World world{scene.Take(), PathOf(root.Child("path"), seed)};
  if (root.Has("second_path")) world.second_path = PathOf(root.Child("second_path"), seed);
  return world;
}

SynthOptions DefaultsOf(const YamlSection& root) {
  SynthOptions options;
  if (!root.Has("options")) return options;
  const YamlSection section = root.Child("options");
  OptionTable table(options);
  for (const std::string& key : section.Keys()) {
    table.Set(key, section.Text(key), section.Where(key));
  }
  return options;
}

}  // namespace

WorldSource ParseWorldFile(const std::string& text, const std::string& source) {
  const YamlSection root = YamlSection::Parse(text, source);
  root.RejectUnknown(
      {"help", "ambient", "shapes", "lamps", "bodies", "path", "second_path", "options"});
  WorldSource world;
  world.name = std::filesystem::path(source).stem().string();
  world.help = root.Has("help") ? root.Text("help") : "a world described by " + source;
  world.defaults = DefaultsOf(root);
  world.make = [root](std::uint64_t seed) { return MakeFromFile(root, seed); };
  world.text = text;
  world.make(world.defaults.seed);  // finds everything that is wrong, whatever the seed
  return world;
}

WorldSource ReadWorldFile(const std::filesystem::path& file) {
  return ParseWorldFile(ReadInputFile(file, kLargestWorld), file.string());
}

}  // namespace plumbline
