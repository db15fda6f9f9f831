// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/nerfstudio.h"

#include "plumbline/io/export/keyframe_images.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

// A pinhole camera of OpenGL looks along -z with y up; pixels are counted from the corner.
TEST(WriteNerfstudioTransforms, CamerasSeeThePointsWhereTheyAre) {
  const ScratchFolder folder;
  const SyntheticWorld world = MakeSyntheticWorld(60, 0);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(30)}, {.noise = 0}).map;
  WriteNerfstudioTransforms(
      folder / "transforms.json", saved, "images", KeyFrameImageNames(saved.map), "points.ply");
  const auto json = nlohmann::json::parse(Contents(folder / "transforms.json"));
  EXPECT_EQ(json["camera_model"], "OPENCV");
  EXPECT_EQ(json["w"], 752);
  EXPECT_EQ(json["h"], 480);
  EXPECT_EQ(json["ply_file_path"], "points.ply");
  for (const char* distortion : {"k1", "k2", "p1", "p2"}) EXPECT_EQ(json[distortion], 0.0);
  ASSERT_EQ(json["frames"].size(), 2U);
  EXPECT_EQ(json["frames"][1]["file_path"], "images/50000000.png");
  int seen = 0;
  for (const auto& [id, point] : saved.map.points()) {
    for (const auto& [keyframe, feature] : point.observations) {
      const auto& rows =
          json["frames"][static_cast<std::size_t>(keyframe.value)]["transform_matrix"];
      Eigen::Matrix4d world_from_camera;
      for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
          world_from_camera(r, c) =
              rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)].get<double>();
        }
      }
      const Eigen::Vector3d p =
          (world_from_camera.inverse() * point.position.homogeneous()).head<3>();
      EXPECT_LT(p.z(), 0);
      const Eigen::Vector2d px(
          json["fl_x"].get<double>() * p.x() / -p.z() + json["cx"].get<double>(),
          -json["fl_y"].get<double>() * p.y() / -p.z() + json["cy"].get<double>());
      const Eigen::Vector2d measured =
          saved.map.Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].px;
      EXPECT_LT((px - measured - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, 40);
}

TEST(WriteNerfstudioTransforms, HasFramesBehindTheKeyframes) {
  const ScratchFolder folder;
  const SyntheticWorld world = MakeSyntheticWorld(60, 0);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(30)}, {.noise = 0}).map;
  const std::vector<PosedImage> others = {{7, "7.png", {{1, 0, 0, 0}, {1, 2, -3}}}};
  WriteNerfstudioTransforms(folder / "transforms.json",
                            saved,
                            "images",
                            KeyFrameImageNames(saved.map),
                            "points.ply",
                            others);
  const auto json = nlohmann::json::parse(Contents(folder / "transforms.json"));
  ASSERT_EQ(json["frames"].size(), 3U);
  EXPECT_EQ(json["frames"][2]["file_path"], "images/7.png");
  EXPECT_EQ(json["frames"][2]["transform_matrix"],
            nlohmann::json::parse("[[1, 0, 0, -1], [0, -1, 0, -2], [0, 0, -1, 3], [0, 0, 0, 1]]"));
}

}  // namespace
}  // namespace plumbline
