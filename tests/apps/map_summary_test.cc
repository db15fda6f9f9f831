// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_summary.h"

#include "plumbline/map/renumbering.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::HasSubstr;

SavedMap WorldMap(double noise) {
  const SyntheticWorld world = MakeSyntheticWorld(60, 10);
  SavedMap saved;
  saved.camera = world.camera;
  saved.version = 1;
  saved.map =
      MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10), PoseOnPath(20)}, {.noise = noise}).map;
  return saved;
}

TEST(Summarize, CountsAndMeasures) {
  const SavedMap saved = WorldMap(0);
  const MapSummary summary = Summarize(saved);
  EXPECT_EQ(summary.keyframes, 3U);
  EXPECT_EQ(summary.points, saved.map.points().size());
  std::size_t observations = 0;
  Eigen::AlignedBox3d box;
  for (const auto& [id, point] : saved.map.points()) {
    observations += point.observations.size();
    box.extend(point.position);
  }
  for (const auto& [id, line] : saved.map.lines()) {
    box.extend(line.Interval().start).extend(line.Interval().end);
  }
  EXPECT_EQ(summary.point_observations, observations);
  EXPECT_EQ(summary.time_ns, std::pair(std::int64_t{0}, std::int64_t{100'000'000}));
  EXPECT_NEAR(summary.path_length,
              CentreDistance(PoseOnPath(0), PoseOnPath(10)) +
                  CentreDistance(PoseOnPath(10), PoseOnPath(20)),
              1e-12);
  EXPECT_TRUE(summary.bounds.isApprox(box));
  EXPECT_TRUE(summary.bounds.contains(summary.middle_bounds));
  EXPECT_LT(summary.middle_bounds.volume(), 0.9 * summary.bounds.volume());
  EXPECT_LT(*summary.reprojection_px, 1e-9);
  EXPECT_GT(*Summarize(WorldMap(1)).reprojection_px, 0.5);
}

// The way from the end of one map to the start of the other was not travelled.
TEST(Summarize, PathsOfMergedMapsAreApart) {
  SavedMap saved = WorldMap(0);
  const double alone = Summarize(saved).path_length;
  saved.map.Absorb(Renumbered(saved.map, Behind(saved.map)), {1, ExpSo3({0, 1, 0}), {100, 0, 0}});
  EXPECT_NEAR(Summarize(saved).path_length, 2 * alone, 1e-9);
}

TEST(MapInfo, SaysInWhatUnitLengthsAre) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", std::string(2'340'000, 'x'));
  SavedMap saved = WorldMap(0);
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("version 1, 2.3 MB\n"));
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("0.1100 m\n"));
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr(" m along the keyframes\n"));
  saved.camera.baseline = 0;
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("none: a single camera; lengths are in"));
  EXPECT_EQ(MapInfoTable(file, saved).find(" m along"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(MapInfoJson(file, saved))["unit"], "of the map");
}

TEST(MapInfo, OfAnEmptyMapHasNoTimesAndNoBounds) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", "x");
  SavedMap saved;
  saved.camera = TestCamera();
  EXPECT_EQ(MapInfoTable(file, saved).find("time"), std::string::npos);
  EXPECT_EQ(MapInfoTable(file, saved).find("bounds"), std::string::npos);
  const auto map = nlohmann::json::parse(MapInfoJson(file, saved))["maps"][0];
  EXPECT_EQ(map["keyframes"], 0);
  for (const char* name : {"first_keyframe_s", "bounds", "mean_reprojection_px"}) {
    EXPECT_TRUE(map[name].is_null()) << name;
  }
}

}  // namespace
}  // namespace plumbline
