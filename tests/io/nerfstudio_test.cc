// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/nerfstudio.h"

#include "plumbline/io/export/keyframe_images.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <array>
#include <cmath>
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
  WriteNerfstudioTransforms(folder / "transforms.json",
                            saved,
                            ExportCamera(saved.camera),
                            KeyFrameImageNames(saved.map),
                            "points.ply");
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
                            ExportCamera(saved.camera),
                            KeyFrameImageNames(saved.map),
                            "points.ply",
                            others);
  const auto json = nlohmann::json::parse(Contents(folder / "transforms.json"));
  ASSERT_EQ(json["frames"].size(), 3U);
  EXPECT_EQ(json["frames"][2]["file_path"], "images/7.png");
  EXPECT_EQ(json["frames"][2]["transform_matrix"],
            nlohmann::json::parse("[[1, 0, 0, -1], [0, -1, 0, -2], [0, 0, -1, 3], [0, 0, 0, 1]]"));
}

// A lens with its numbers by name, and the pose of the camera that delivered the images.
TEST(WriteNerfstudioTransforms, HasTheLensOfImagesAsDelivered) {
  const ScratchFolder folder;
  const RectifiedCamera rectified = MakeSyntheticWorld(0, 0).camera;
  const auto written = [&](DistortionModel model, std::array<double, kMostCoefficients> k) {
    CameraIntrinsics in;
    in.fx = 190;
    in.fy = 191;
    in.cx = 371;
    in.cy = 235;
    in.width = 752;
    in.height = 480;
    in.model = model;
    in.distortion = k;
    EXPECT_TRUE(NerfstudioKnows(in));
    // A quarter turn about z: the camera's x points along -y of the rectified frame.
    const Eigen::Quaterniond turn(std::sqrt(0.5), 0, 0, -std::sqrt(0.5));
    WriteNerfstudioTransforms(folder / "transforms.json",
                              SavedMap(),
                              ExportCamera(rectified, turn, Camera(in)),
                              {},
                              "points.ply",
                              std::vector<PosedImage>{{7, "7.png", {}}});
    return nlohmann::json::parse(Contents(folder / "transforms.json"));
  };
  const auto fisheye = written(DistortionModel::kEquidistant, {0.1, 0.02, 0.003, 0.0004});
  EXPECT_EQ(fisheye["camera_model"], "OPENCV_FISHEYE");
  EXPECT_EQ(fisheye["w"], 752);
  EXPECT_EQ(fisheye["fl_x"], 190);
  EXPECT_EQ(fisheye["fl_y"], 191);
  EXPECT_EQ(fisheye["cx"], 371.5);
  EXPECT_EQ(fisheye["k1"], 0.1);
  EXPECT_EQ(fisheye["k4"], 0.0004);
  EXPECT_FALSE(fisheye.contains("p1"));
  const auto& pose = fisheye["frames"][0]["transform_matrix"];
  EXPECT_NEAR(pose[1][0].get<double>(), -1, 1e-12);
  EXPECT_NEAR(pose[0][0].get<double>(), 0, 1e-12);
  const auto radtan = written(DistortionModel::kRadTan, {-0.28, 0.07, 0.0002, 0.00002, 0.5});
  EXPECT_EQ(radtan["camera_model"], "OPENCV");
  EXPECT_EQ(radtan["k2"], 0.07);
  EXPECT_EQ(radtan["p1"], 0.0002);
  EXPECT_EQ(radtan["p2"], 0.00002);
  EXPECT_EQ(radtan["k3"], 0.5);
  CameraIntrinsics other;
  other.model = DistortionModel::kFov;
  other.distortion = {0.9};
  EXPECT_FALSE(NerfstudioKnows(other));
}

}  // namespace
}  // namespace plumbline
