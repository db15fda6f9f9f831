// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_summary.h"

#include "plumbline/map/combined_atlases.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <algorithm>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;

struct WorldMap {
  RectifiedCamera camera;
  Map map;
};

WorldMap MakeWorldMap(double noise) {
  const SyntheticWorld world = MakeSyntheticWorld(60, 10);
  return {
      world.camera,
      MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10), PoseOnPath(20)}, {.noise = noise}).map};
}

// The first one is to be gone on with.
SavedAtlas AtlasOf(const std::vector<Map>& maps) {
  SavedAtlas saved;
  saved.context.camera = TestCamera();
  saved.file_version = 1;
  for (const Map& map : maps) saved.atlas.Adopt(map);
  if (!maps.empty()) saved.atlas.Activate(maps.front().id());
  return saved;
}

TEST(Summarize, CountsAndMeasures) {
  const WorldMap saved = MakeWorldMap(0);
  const MapSummary summary = Summarize(saved.camera, saved.map);
  EXPECT_EQ(summary.keyframes, 3U);
  EXPECT_EQ(summary.points, saved.map.points().size());
  std::size_t observations = 0;
  Eigen::AlignedBox3d box;
  for (const auto& [id, point] : saved.map.points()) {
    observations += point.observations.size();
    box.extend(point.position);
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
  const WorldMap noisy = MakeWorldMap(1);
  EXPECT_GT(*Summarize(noisy.camera, noisy.map).reprojection_px, 0.5);
}

// The lines of this map are shown by three keyframes, too few for bounds beside points.
TEST(Summarize, BoundsWithoutPointsAreOfLines) {
  WorldMap saved = MakeWorldMap(0);
  MapEdit edit;
  for (const auto& [id, point] : saved.map.points()) edit.push_back(edit::RemovePoint{id});
  saved.map.Apply(edit);
  Eigen::AlignedBox3d box;
  for (const auto& [id, line] : saved.map.lines()) {
    box.extend(line.Interval().start).extend(line.Interval().end);
  }
  EXPECT_TRUE(Summarize(saved.camera, saved.map).bounds.isApprox(box));
}

// The way from the end of one map to the start of the other was not travelled.
TEST(Summarize, PathsOfMergedMapsAreApart) {
  WorldMap saved = MakeWorldMap(0);
  const double alone = Summarize(saved.camera, saved.map).path_length;
  saved.map.Absorb(Renumbered(saved.map, Behind(saved.map)), {1, ExpSo3({0, 1, 0}), {100, 0, 0}});
  EXPECT_NEAR(Summarize(saved.camera, saved.map).path_length, 2 * alone, 1e-9);
}

TEST(MapInfo, SaysInWhatUnitLengthsAre) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", std::string(2'340'000, 'x'));
  SavedAtlas saved = AtlasOf({MakeWorldMap(0).map});
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("version 1, 2.3 MB\n"));
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("0.1100 m\n"));
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr(" m along the keyframes\n"));
  saved.context.camera.baseline = 0;
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("none: a single camera; lengths are in"));
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr(" units along the keyframes\n"));
  EXPECT_THAT(MapInfoTable(file, saved), ContainsRegex("bounds .* to [0-9.-]+ units\n"));
  EXPECT_EQ(nlohmann::json::parse(MapInfoJson(file, saved))["unit"], "of the map");
}

TEST(MapInfo, CountsTheMaps) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", "x");
  SavedAtlas saved;
  saved.context.camera = TestCamera();
  EXPECT_THAT(MapInfoTable(file, saved), EndsWith("maps          0\n"));
  EXPECT_EQ(nlohmann::json::parse(MapInfoJson(file, saved))["maps"].size(), 0U);
  saved = AtlasOf({Map()});
  EXPECT_THAT(MapInfoTable(file, saved), HasSubstr("maps          1 (number 0)\nkeyframes"));
  saved = AtlasOf({MakeWorldMap(0).map, Map(MapId{1})});
  EXPECT_THAT(
      MapInfoTable(file, saved),
      AllOf(HasSubstr("maps          2 (number 0, of which the rest speaks)\nkeyframes     3\n"),
            EndsWith("map 1         0 keyframes, 0 points, 0 lines\n")));
  const auto maps = nlohmann::json::parse(MapInfoJson(file, saved))["maps"];
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0]["id"], 0);
  EXPECT_EQ(maps[0]["keyframes"], 3);
  EXPECT_EQ(maps[1]["id"], 1);
}

TEST(MapInfo, TellsTheMemoryByKindWhereAsked) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", "x");
  const Map map = MakeWorldMap(0).map;
  const SavedAtlas saved = AtlasOf({map});
  EXPECT_EQ(MapInfoTable(file, saved).find("memory"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(MapInfoJson(file, saved)).contains("memory"));
  const auto memory = nlohmann::json::parse(MapInfoJson(file, saved, true))["memory"];
  std::size_t features = 0, observations = 0, all = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    features += keyframe.frame.features().points.size();
  }
  for (const auto& [id, point] : map.points()) observations += point.observations.size();
  for (const auto& [key, part] : memory.items()) {
    EXPECT_EQ(key.find(' '), std::string::npos);
    EXPECT_THAT(key, EndsWith("_bytes"));
    all += part.get<std::size_t>();
  }
  const std::size_t bytes = memory["point_features_bytes"];
  EXPECT_GE(bytes, features * sizeof(PointFeature));
  EXPECT_LE(bytes, 2 * features * (sizeof(PointFeature) + sizeof(std::optional<Disparity>)));
  EXPECT_EQ(memory["points_bytes"], map.points().size() * sizeof(MapPoint));
  EXPECT_GE(memory["observations_bytes"].get<std::size_t>(),
            observations * sizeof(Observations::value_type));
  const std::string table = MapInfoTable(file, saved, true);
  EXPECT_THAT(table, HasSubstr("  point features "));
  EXPECT_THAT(table,
              EndsWith(fmt::format("{:>10.0f} kB {:>8.1f} kB a keyframe\n",
                                   static_cast<double>(all) / 1e3,
                                   static_cast<double>(all) / 3e3)));
}

TEST(MapInfo, TellsTheLensThatWasLearned) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", "x");
  WorldMap saved = MakeWorldMap(0);
  const auto lens = [&](const SavedAtlas& atlas) {
    return nlohmann::json::parse(MapInfoJson(file, atlas))["maps"][0]["lens_correction_px"];
  };
  EXPECT_EQ(lens(AtlasOf({saved.map})), 0);
  EXPECT_EQ(MapInfoTable(file, AtlasOf({saved.map})).find("lens"), std::string::npos);
  saved.map.Apply({edit::CorrectFeatures{{{}, {saved.camera, 3.25}}}});
  EXPECT_EQ(lens(AtlasOf({saved.map})), 3.25);
  EXPECT_THAT(MapInfoTable(file, AtlasOf({saved.map})),
              HasSubstr("lens          corrected by 3.2 px at the image's side\n"));
}

TEST(MapInfo, TakesNamesThatAreNotUtf8) {
  const ScratchFolder folder;
  const auto file = folder.Write("m\xFF.plb", "x");
  const auto json = nlohmann::json::parse(MapInfoJson(file, AtlasOf({Map()})));
  EXPECT_THAT(json["file"].get<std::string>(), EndsWith("/m\xEF\xBF\xBD.plb"));
}

TEST(MapInfo, OfAnEmptyMapHasNoTimesAndNoBounds) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", "x");
  const SavedAtlas saved = AtlasOf({Map()});
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
