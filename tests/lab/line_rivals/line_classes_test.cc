// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_classes.h"

#include "plumbline/matching/line_from_views.h"

#include "tests/support/true_map.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::array kAll = EnumNames(std::type_identity<LineClass>{});

struct Scene {
  SyntheticWorld world = MakeSyntheticWorld(0, 150);
  Map map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(12), PoseOnPath(24)}, {.noise = 0}).map;

  std::vector<LineViewOf> ViewsOf(const MapLine& line) const {
    std::vector<LineViewOf> views;
    for (const auto& [keyframe, feature] : line.observations) {
      views.push_back({keyframe, static_cast<std::size_t>(feature)});
    }
    return views;
  }
};

TEST(LineClass, PartsLinesByLengthAndDistance) {
  const Scene scene;
  int short_ones = 0, long_ones = 0, near_ones = 0, far_ones = 0;
  for (const auto& [id, line] : scene.map.lines()) {
    const auto in = [&](LineClass which) {
      return IsInClass(which, scene.map, scene.world.camera, line);
    };
    EXPECT_FALSE(in(LineClass::kShort) && in(LineClass::kLong));
    EXPECT_NE(in(LineClass::kNear), in(LineClass::kFar));
    short_ones += in(LineClass::kShort);
    long_ones += in(LineClass::kLong);
    near_ones += in(LineClass::kNear);
    far_ones += in(LineClass::kFar);
  }
  for (const int count : {short_ones, long_ones, near_ones, far_ones}) EXPECT_GT(count, 0);
}

// A frame 2 m above a floor, and a second one 1 m further along z.
TEST(LineClass, KnowsUprightLinesLowOnesAndThoseAlongTheWay) {
  SyntheticWorld world = MakeSyntheticWorld(0, 3);
  world.lines[0].segment = {{1, -1, 6}, {1, 1, 6}};       // a post
  world.lines[1].segment = {{-1, 1.8, 4}, {-1, 1.8, 7}};  // a kerb
  world.lines[2].segment = {{-1, -1, 6}, {1, -1, 6}};     // a lintel
  const Rigid3 ahead = Inverse(Rigid3{Eigen::Quaterniond::Identity(), {0, 0, 1}});
  const TrueMap scene = MakeTrueMap(world, {Rigid3{}, ahead}, {.noise = 0, .missed = 0});
  const auto in = [&](std::size_t index, LineClass which) {
    const MapLine& line = *scene.map.Find(scene.line_of.at(index));
    return IsInClass(which, scene.map, world.camera, line);
  };
  EXPECT_TRUE(in(0, LineClass::kUpright));
  EXPECT_FALSE(in(0, LineClass::kAlongMotion));
  EXPECT_FALSE(in(0, LineClass::kLow));
  EXPECT_FALSE(in(1, LineClass::kUpright));
  EXPECT_TRUE(in(1, LineClass::kAlongMotion));
  EXPECT_TRUE(in(1, LineClass::kLow));
  for (const LineClass which : {LineClass::kUpright, LineClass::kAlongMotion, LineClass::kLow}) {
    EXPECT_FALSE(in(2, which));
  }
}

TEST(LinesWithoutClass, MakeAllOthersAsBefore) {
  const Scene scene;
  for (const auto& [which, name] : kAll) {
    const auto make = LinesWithoutClass(std::string("without_") + name);
    ASSERT_NE(make, nullptr);
    int made = 0, left_out = 0;
    for (const auto& [id, line] : scene.map.lines()) {
      if (line.observations.size() < 2) continue;
      const auto views = scene.ViewsOf(line);
      const auto usual = LineFromViews(scene.map, scene.world.camera, views);
      const auto found = make(scene.map, scene.world.camera, views);
      if (!usual) {
        EXPECT_FALSE(found);
        continue;
      }
      const bool out = IsInClass(which, scene.map, scene.world.camera, *usual);
      EXPECT_EQ(found.has_value(), !out) << name;
      if (found) {
        EXPECT_EQ(found->line.moment, usual->line.moment);
      }
      ++(out ? left_out : made);
    }
    EXPECT_GT(made, 5) << name;
  }
  EXPECT_EQ(LinesWithoutClass("n_view"), nullptr);
  EXPECT_EQ(LinesWithoutClass("without_colour"), nullptr);
}

}  // namespace
}  // namespace plumbline
