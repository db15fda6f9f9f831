// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"

#include "tests/io/scratch_folder.h"
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace stella_vslam_test {

using testing::HasSubstr;

const std::string kPerspective =
    "# one camera\nCamera:\n  name: \"a camera\"\n  setup: \"monocular\"\n  model: "
    "\"perspective\"\n"
    "  fx: 458.6\n  fy: 457.3\n  cx: 367.2\n  cy: 248.4\n  k1: -0.28\n  k2: 0.07\n  p1: 0.0002\n"
    "  p2: 1.8e-05\n  k3: 0.0\n  fps: 20.0\n  cols: 752\n  rows: 480\n  color_order: \"Gray\"\n"
    "Preprocessing:\n  min_size: 800\n";

std::string With(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The same with whole keys, as before 2021.
std::string Flat(const std::string& text) {
  std::string flat;
  std::string group;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with(':')) {
      group = line.substr(0, line.size() - 1);
    } else {
      flat += (line.starts_with("  ") ? group + "." + line.substr(2) : line) + "\n";
    }
  }
  return flat;
}

TEST(ReadStellaVslam, ReadsGroupsAndWholeKeys) {
  for (const std::string& text : {kPerspective, Flat(kPerspective)}) {
    const Calibration c = ParseCamera(text, "camera.yaml");
    EXPECT_EQ(c.left,
              Camera({.fx = 458.6,
                      .fy = 457.3,
                      .cx = 367.2,
                      .cy = 248.4,
                      .width = 752,
                      .height = 480,
                      .model = DistortionModel::kRadTan,
                      .distortion = {-0.28, 0.07, 0.0002, 1.8e-05}}));
    EXPECT_EQ(c.rate_hz, 20);
    EXPECT_FALSE(c.right);
    EXPECT_FALSE(c.depth_factor);
  }
}

TEST(ReadStellaVslam, ReadsAFisheye) {
  const std::string text =
      With(With(With(With(kPerspective, "perspective", "fisheye"), "p1", "k3"), "p2", "k4"),
           "  k3: 0.0\n",
           "");
  const CameraIntrinsics k = ParseCamera(text, "camera.yaml").left.intrinsics();
  EXPECT_EQ(k.model, DistortionModel::kEquidistant);
  EXPECT_EQ(k.distortion[3], 1.8e-05);
}

TEST(ReadStellaVslam, KnowsDepthByTheSetup) {
  const std::string text = With(kPerspective, "monocular", "RGBD");
  for (const std::string& with :
       {text + "  depthmap_factor: 5000.0\n", Flat(text) + "depthmap_factor: 5000.0\n"}) {
    EXPECT_EQ(ParseCamera(with, "camera.yaml").depth_factor, 5000);
  }
}

const std::string kRectified = With(
    With(With(kPerspective, "monocular", "stereo"), "k1: -0.28\n  k2: 0.07\n", "k1: 0\n  k2: 0\n"),
    "p1: 0.0002\n  p2: 1.8e-05\n  k3: 0.0\n",
    "p1: 0\n  p2: 0\n  k3: 0.0\n  focal_x_baseline: 45.86\n");

TEST(ReadStellaVslam, ARectifiedPairHasTheBaseline) {
  for (const std::string& text : {kRectified, Flat(kRectified)}) {
    const Calibration c = ParseCamera(text, "camera.yaml");
    ASSERT_TRUE(c.right);
    EXPECT_TRUE(c.rectified);
    EXPECT_LT((c.right_from_left.translation - Eigen::Vector3d(-0.1, 0, 0)).norm(), 1e-12);
  }
}

// The rectified frames are those of the left camera, and the right one turned by a right angle.
TEST(ReadStellaVslam, ARawPairFollowsFromItsRectification) {
  const std::string raw =
      kRectified +
      "StereoRectifier:\n  model: \"fisheye\"\n"
      "  K_left: [190, 0.0, 375, 0.0, 191, 240, 0.0, 0.0, 1.0]\n  D_left: [0.1, 0.2, 0.3, 0.4]\n"
      "  R_left: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
      "  K_right: [192, 0.0, 376, 0.0, 193, 241, 0.0, 0.0, 1.0]\n  D_right: [0.5, 0.6, 0.7, 0.8]\n"
      "  R_right: [1, 0, 0, 0, 0, -1, 0, 1, 0]\n";
  for (const std::string& text : {raw, Flat(raw)}) {
    const Calibration c = ParseCamera(text, "camera.yaml");
    ASSERT_TRUE(c.right);
    EXPECT_FALSE(c.rectified);
    EXPECT_EQ(c.left.intrinsics().fx, 190);
    EXPECT_EQ(c.right->intrinsics().cy, 241);
    EXPECT_EQ(c.right->intrinsics().model, DistortionModel::kEquidistant);
    EXPECT_EQ(c.right->intrinsics().distortion[1], 0.6);
    // x_right = R_right^T (x_left - b), R_right^T (x, y, z) = (x, z, -y).
    EXPECT_LT((c.right_from_left * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(0.9, 3, -2)).norm(),
              1e-12);
  }
}

TEST(ReadStellaVslam, SaysWhatIsWrong) {
  const auto message = [](const std::string& from, const std::string& to) {
    return MessageOf([&] { ParseCamera(With(kPerspective, from, to), "camera.yaml"); });
  };
  EXPECT_EQ(
      message("perspective", "equirectangular"),
      "camera.yaml:5: Camera.model: expected perspective or fisheye, found 'equirectangular'");
  EXPECT_EQ(MessageOf([] {
              ParseCamera(Flat(With(kPerspective, "perspective", "radial_division")), "c.yaml");
            }),
            "c.yaml:4: Camera.model: expected perspective or fisheye, found 'radial_division'");
  EXPECT_THAT(message("monocular", "stereo"), HasSubstr("Camera.focal_x_baseline: expected"));
  EXPECT_THAT(message("monocular", "lidar"),
              HasSubstr("camera.yaml:4: Camera.setup: expected monocular, stereo or RGBD"));
  EXPECT_THAT(message("  cols: 752\n", ""), HasSubstr("Camera.cols: expected the size"));
  EXPECT_THAT(message("458.6", "-458.6"), HasSubstr("camera.yaml:6: Camera.fx: expected fx"));
  EXPECT_THAT(message("fps: 20.0", "fps: 1e9"), HasSubstr("Camera.fps: expected a rate from"));
}

}  // namespace stella_vslam_test
}  // namespace plumbline
