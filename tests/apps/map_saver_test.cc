// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_saver.h"

#include "plumbline/io/map_file/map_io.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/misfits.h"
#include "tests/support/true_map.h"
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace map_saver_test {

// A map whose lines two keyframes have left behind, as they do when they are adjusted.
SavedAtlas MapWithMisfits(const SyntheticWorld& world) {
  TrueMap scene = MakeTrueMap(
      world, {PoseOnPath(0), PoseOnPath(8), PoseOnPath(16), PoseOnPath(24)}, {.noise = 0.3});
  MapEdit edit;
  for (const auto& [id, line] : scene.map.lines()) {
    const Rigid3 shift{Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1, 0.1, 0.1)};
    edit.push_back(
        edit::MoveLine{id, Transform(shift, line.line), line.start, line.end, line.information});
  }
  scene.map.Apply(edit);
  SavedAtlas saved;
  saved.context.camera = world.camera;
  const MapId id = scene.map.id();
  saved.context.maps[id] = {};
  saved.atlas.Adopt(std::move(scene.map));
  saved.atlas.Activate(id);
  return saved;
}

TEST(MapSaver, WritesLandmarksThatFit) {
  const SyntheticWorld world = MakeSyntheticWorld(100, 60);
  const SavedAtlas broken = MapWithMisfits(world);
  const ObservationCount before =
      CountMisfits(broken.atlas.maps().begin()->second, world.camera).lines;
  ASSERT_GT(before.Share(), 0.3);
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "map.plb";
  MapSaver saver(file, LineSettings{});
  saver.Take(broken);
  constexpr int kPatience = 1000;
  for (int i = 0; i < kPatience && !std::filesystem::exists(file); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(saver.TakeFailure(), std::nullopt);
  const ObservationCount after = CountMisfits(LoadMap(file).map, world.camera).lines;
  EXPECT_EQ(after.beyond, 0);
  EXPECT_GE(after.all, 0.98 * before.all);
}

}  // namespace map_saver_test
}  // namespace plumbline
