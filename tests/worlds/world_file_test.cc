// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/world_file.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "worlds/scene_builder.h"
#include "worlds/sequence.h"
#include "worlds/write_sequence.h"

#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kShapes = R"(shapes:
  - {shape: room, size: [4, 3, 2.5], wall: plaster, floor: planks}
  - {shape: box, base: [1, 1, 0], size: [0.5, 0.4, 0.9], yaw_deg: 90, material: cardboard, tone: 0.6, glow: 0.1}
  - shape: wall
    from: [1, 2, 0]
    to: [3, 2, 0]
    height: 2.5
    thickness: 0.2
    material: brick
    openings: [{along: 0.5, width: 0.8, height: 2}, {along: 1.5, width: 0.3, bottom: 1, height: 0.5}]
  - {shape: bar, from: [0, 0, 1], to: [1, 0, 1], thickness: 0.02, material: metal, tone: 0.3}
  - {shape: prism, from: [2, 1, 0], to: [2, 1, 1], radius: 0.2, sides: 8, material: concrete}
  - {shape: panel, corner: [0, 1, 1], u: [0, 1, 0], v: [0, 0, 1], material: poster, edges: false}
  - {shape: floor, corner: [0, 0, 0.01], size: [1, 2], material: carpet}
  - {shape: ceiling, corner: [0, 0, 2.4], size: [1, 2], material: acoustic, tone: 0.8}
)";
const std::string kPath =
    "path: {waypoints: [{at: [1, 0.5, 1.4], yaw_deg: 45}, {at: [2, 0.5, 1.4], yaw_deg: 90}]}\n";

Scene SameByHand(std::uint64_t seed) {
  SceneBuilder scene(seed);
  scene.AddRoom({4, 3, 2.5}, Material::kPlaster, Material::kPlanks);
  scene.AddBox(
      {{1, 1, 0}, {0.5, 0.4, 0.9}, 90 * (std::numbers::pi / 180)}, Material::kCardboard, 0.6, 0.1);
  const std::vector<Opening> openings = {{0.5, 0.8, 0, 2}, {1.5, 0.3, 1, 0.5}};
  scene.AddWall({{1, 2, 0}, {3, 2, 0}, 2.5, 0.2}, openings, Material::kBrick, 0.5);
  scene.AddBar({0, 0, 1}, {1, 0, 1}, 0.02, Material::kMetal, 0.3);
  scene.AddPrism({2, 1, 0}, {2, 1, 1}, {0.2, 8}, Material::kConcrete, 0.5);
  scene.AddPanel({0, 1, 1}, {0, 1, 0}, {0, 0, 1}, {Material::kPoster, 0.5, false});
  scene.AddFloor({0, 0, 0.01}, {1, 2}, Material::kCarpet, 0.5);
  scene.AddCeiling({0, 0, 2.4}, {1, 2}, Material::kAcoustic, 0.8);
  return scene.Take();
}

TEST(WorldFile, MakesWhatTheBuilderMakes) {
  const World read = ParseWorldFile(kShapes + kPath, "my/den.yaml").make(3);
  const Scene built = SameByHand(3);
  ASSERT_EQ(read.scene.surfaces.size(), built.surfaces.size());
  for (std::size_t i = 0; i < built.surfaces.size(); ++i) {
    const Surface &a = read.scene.surfaces[i], &b = built.surfaces[i];
    EXPECT_EQ(a.origin, b.origin) << i;
    EXPECT_EQ(a.side_u, b.side_u) << i;
    EXPECT_EQ(a.side_v, b.side_v) << i;
    EXPECT_EQ(a.texture.seed, b.texture.seed) << i;
    EXPECT_EQ(a.texture.material, b.texture.material) << i;
    EXPECT_EQ(a.texture.tone, b.texture.tone) << i;
    EXPECT_EQ(a.glow, b.glow) << i;
  }
  ASSERT_EQ(read.scene.edges.size(), built.edges.size());
  for (std::size_t i = 0; i < built.edges.size(); ++i) {
    EXPECT_EQ(read.scene.edges[i].start, built.edges[i].start) << i;
  }
  const CameraPath path = SplinePath({{{1, 0.5, 1.4}, 45 * (std::numbers::pi / 180)},
                                      {{2, 0.5, 1.4}, 90 * (std::numbers::pi / 180)}},
                                     {1, 1});
  EXPECT_EQ(read.path.duration, path.duration);
  EXPECT_EQ(read.path.world_from_camera(0.7).translation, path.world_from_camera(0.7).translation);
}

TEST(WorldFile, HasLampsBodiesASecondPathAndOptions) {
  const std::string rest = R"(help: a den
ambient: 0.1
lamps:
  - {centre: [2, 1, 2.4], size: [1, 0.2], power: 3}
  - {centre: [1, 1, 2], u: [0.1, 0, 0], v: [0, 0.1, 0], power: 2}
  - {centre: [1, 1, 1], power: 1}
bodies:
  - pivot: [2, 2, 1]
    shift: [0, 0, 1]
    period_s: 2
    turn_deg_per_s: 90
    shapes: [{shape: box, base: [0, 0, 0], size: [1, 1, 1], material: wood}]
second_path: {carrier: wheels, waypoints: [{at: [1, 1, 1], pause_s: 1}, {at: [1, 1, 1], yaw_deg: 5}]}
options: {rate_hz: 10, noise: 0.5}
)";
  const WorldSource source = ParseWorldFile(kShapes + kPath + rest, "my/den.yaml");
  EXPECT_EQ(source.name, "den");
  EXPECT_EQ(source.help, "a den");
  EXPECT_EQ(source.defaults.rate_hz, 10);
  EXPECT_EQ(source.defaults.noise, 0.5);
  const World world = source.make(1);
  ASSERT_EQ(world.scene.lamps.size(), 3U);
  EXPECT_EQ(world.scene.ambient, 0.1);
  EXPECT_GE(world.second_path.value().duration, 1);
  ASSERT_EQ(world.scene.bodies.size(), 1U);
  const Rigid3 half = world.scene.bodies[0].world_from_body(1);  // half a period, a quarter turn
  EXPECT_TRUE(half.translation.isApprox(Eigen::Vector3d(2, 2, 2), 1e-12));
  EXPECT_TRUE((half.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_EQ(world.scene.surfaces.back().body, 0);
}

struct BadFile {
  const char* what;
  std::string text;
  std::string message;
};

std::vector<BadFile> BadShapes() {
  const auto shape = [](const std::string& text) {
    return "shapes:\n  - {shape: " + text + "}\n" + kPath;
  };
  return {
      {"nothing", "", "den.yaml"},
      {"no shapes", kPath, "shapes: expected a list of groups"},
      {"no path", kShapes, "path: expected a group of keys"},
      {"a list of numbers", "shapes: [1]\n" + kPath, "den.yaml:1: shapes[0]: expected a group"},
      {"another key", kShapes + kPath + "lights: []\n", "unknown key 'lights'"},
      {"another shape",
       shape("ball, radius: 1"),
       "den.yaml:2: shapes[0].shape: expected one of room, box"},
      {"another material",
       shape("box, base: [0, 0, 0], size: [1, 1, 1], material: gold"),
       "material: expected one of paint, plaster"},
      {"no material", shape("box, base: [0, 0, 0], size: [1, 1, 1]"), "material: expected a value"},
      {"tone",
       shape("box, base: [0, 0, 0], size: [1, 1, 1], material: wood, tone: 2"),
       "tone: expected a number from 0 to 1, found 2"},
      {"a flat box",
       shape("box, base: [0, 0, 0], size: [1, 0, 1], material: wood"),
       "size: expected numbers from 0.0001"},
      {"a far box",
       shape("box, base: [0, 1e5, 0], size: [1, 1, 1], material: wood"),
       "base: expected numbers from -10000 to 10000, found 100000"},
      {"not a number",
       shape("box, base: [0, nan, 0], size: [1, 1, 1], material: wood"),
       "base: expected"},
      {"misspelt key",
       shape("box, base: [0, 0, 0], sise: [1, 1, 1], material: wood"),
       "unknown key 'shapes[0].sise'; did you mean 'size'?"},
      {"an odd prism",
       shape("prism, from: [0, 0, 0], to: [0, 0, 1], radius: 1, sides: 7, material: wood"),
       "sides: expected an even number, found 7"},
      {"a bar of no length",
       shape("bar, from: [0, 0, 0], to: [0, 0, 0], thickness: 1, material: wood"),
       "to: expected another place than from"},
      {"an oblique panel",
       shape("panel, corner: [0, 0, 0], u: [1, 0, 0], v: [1, 1, 0], material: wood"),
       "v: expected a side normal to u"},
      {"a wall that climbs",
       shape("wall, from: [0, 0, 0], to: [1, 0, 1], height: 2, material: wood"),
       "to: expected a place as high as from"},
      {"holes that overlap",
       shape("wall, from: [0, 0, 0], to: [3, 0, 0], height: 2, material: wood, openings: "
             "[{along: 0.5, width: 1, height: 1}, {along: 1, width: 1, height: 1}]"),
       "openings[1].along: expected a number from 1.5 to 3, found 1"},
      {"a hole through the top",
       shape("wall, from: [0, 0, 0], to: [3, 0, 0], height: 2, material: wood, openings: "
             "[{along: 0.5, width: 1, bottom: 1.5, height: 1}]"),
       "openings[0].height: expected a number from 0.0001 to 0.5, found 1"},
  };
}

std::vector<BadFile> BadPathsAndTheRest() {
  const auto way = [](const std::string& text) { return kShapes + "path: " + text + "\n"; };
  return {
      {"one waypoint",
       way("{waypoints: [{at: [0, 0, 1]}]}"),
       "waypoints: expected 2 or more, found 1"},
      {"a path that stays",
       way("{waypoints: [{at: [0, 0, 1]}, {at: [0, 0, 1]}]}"),
       "waypoints: expected places apart"},
      {"a path of a year",
       way("{speed: 0.01, waypoints: [{at: [-9999, 0, 1]}, {at: [9999, 0, 1]}]}"),
       "waypoints: expected a way of at most 86400 s"},
      {"another carrier",
       way("{carrier: horse, waypoints: [{at: [0, 0, 1]}, {at: [1, 0, 1]}]}"),
       "carrier: expected tripod, hand"},
      {"two kinds of lamp",
       kShapes + kPath + "lamps: [{centre: [0, 0, 2], size: [1, 1], u: [1, 0, 0], power: 1}]\n",
       "lamps[0].u: expected either size"},
      {"an unknown option",
       "options:\n  rate: 10\n" + kShapes + kPath,
       "den.yaml:2: unknown option 'rate'"},
      {"an option out of range",
       "options:\n  seed: 3\n  rate_hz: -1\n" + kShapes + kPath,
       "den.yaml:3: rate_hz: expected a number, 0.1 to 1000, found '-1'"},
      {"an option of many values",
       "options:\n  rate_hz: [1, 2]\n" + kShapes + kPath,
       "den.yaml:2: options.rate_hz: expected one value"},
  };
}

TEST(WorldFile, SaysWhatIsWrongAndWhere) {
  std::vector<BadFile> files = BadShapes();
  for (BadFile& bad : BadPathsAndTheRest()) files.push_back(std::move(bad));
  for (const BadFile& bad : files) {
    try {
      ParseWorldFile(bad.text, "den.yaml");
      ADD_FAILURE() << bad.what << " was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("den.yaml")) << bad.what;
      EXPECT_THAT(error.what(), Not(HasSubstr("--set"))) << bad.what;
      EXPECT_THAT(error.what(), HasSubstr(bad.message)) << bad.what;
    }
  }
}

TEST(WorldFile, IsRenderedAndKeptBesideTheSequence) {
  const ScratchFolder folder;
  const auto file = folder / "den.yaml";
  const std::string text =
      kShapes + kPath + "lamps: [{centre: [2, 1, 2.3], size: [1, 0.2], power: 4}]\n";
  std::ofstream(file) << text;
  SynthOptions options;
  options.frames = 2;
  options.scale = 0.2;
  options.texel = 8;
  options.samples = 1;
  const SyntheticSequence sequence(file.string(), options, 1);
  EXPECT_EQ(sequence.world(), "den");
  EXPECT_EQ(sequence.size(), 2);
  WriteSequence(sequence, SequenceFormat::kEuroc, folder / "out", 1);
  EXPECT_EQ(ReadInputFile(folder / "out/described_world.yaml"), text);
  const GrayImage image = sequence.RenderImage(0, 0);
  int brightest = 0, darkest = 255;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      brightest = std::max<int>(brightest, image.at(x, y));
      darkest = std::min<int>(darkest, image.at(x, y));
    }
  }
  EXPECT_GT(brightest, darkest + 40);
}

TEST(WorldFile, TheExampleIsAWorld) {
  const WorldSource shed = ReadWorldFile(PLUMBLINE_EXAMPLES "/worlds/shed.yaml");
  EXPECT_EQ(shed.name, "shed");
  EXPECT_GT(shed.make(1).path.duration, 5);
  EXPECT_THROW(ReadWorldFile(PLUMBLINE_EXAMPLES "/worlds/none.yaml"), InputError);
}

}  // namespace
}  // namespace plumbline
