// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

// The rows of KITTI 00, whose cameras with colours stand 6 cm to the left of camera 0 and of camera
// 1, and some millimetres off the line between them.
const std::string kColorCalibration =
    "P0: 7.188560000000e+02 0 6.071928000000e+02 0 0 7.188560000000e+02 1.852157000000e+02 0 0 0 1 "
    "0\n"
    "P1: 7.188560000000e+02 0 6.071928000000e+02 -3.861448000000e+02 0 7.188560000000e+02 "
    "1.852157000000e+02 0 0 0 1 0\n"
    "P2: 7.188560000000e+02 0 6.071928000000e+02 4.538225000000e+01 0 7.188560000000e+02 "
    "1.852157000000e+02 -1.130887000000e-01 0 0 1 3.779761000000e-03\n"
    "P3: 7.188560000000e+02 0 6.071928000000e+02 -3.372877000000e+02 0 7.188560000000e+02 "
    "1.852157000000e+02 2.369057000000e+00 0 0 1 4.915215000000e-03\n";

// The place in pixels of a point of camera 0, as the row of calib.txt has it.
Eigen::Vector2d ByRow(const Eigen::Matrix<double, 3, 4>& p, const Eigen::Vector3d& point) {
  return (p * point.homogeneous()).hnormalized();
}

TEST(KittiCalibration, CamerasWithColoursStandWhereTheirProjectionsSay) {
  const ScratchFolder folder;
  const auto file = folder.Write("calib.txt", kColorCalibration);
  const Calibration c = ReadKittiCalibration(file, {2, 3}, {1241, 376});
  Eigen::Matrix<double, 3, 4> p2, p3;
  p2 << 718.856, 0, 607.1928, 45.38225, 0, 718.856, 185.2157, -0.1130887, 0, 0, 1, 0.003779761;
  p3 << 718.856, 0, 607.1928, -337.2877, 0, 718.856, 185.2157, 2.369057, 0, 0, 1, 0.004915215;
  ASSERT_TRUE(c.right && c.body_from_left);
  EXPECT_FALSE(c.rectified);  // 3 mm above one another
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(1, 2, 10), Eigen::Vector3d(-3, 0.5, 5)}) {
    const Eigen::Vector3d in_left = Inverse(*c.body_from_left) * point;
    EXPECT_LT((*c.left.Project(in_left) - ByRow(p2, point)).norm(), 1e-9);
    EXPECT_LT((*c.right->Project(c.right_from_left * in_left) - ByRow(p3, point)).norm(), 1e-9);
  }
  EXPECT_NEAR(c.right_from_left.translation.x(), -0.53329, 1e-5);
  const Calibration grey = ReadKittiCalibration(file, {0, 1}, {1241, 376});
  EXPECT_TRUE(grey.rectified);
  EXPECT_FALSE(grey.body_from_left);
  EXPECT_EQ(grey.right_from_left.translation, Eigen::Vector3d(-386.1448 / 718.856, 0, 0));
}

// A folder of KITTI odometry with the cameras 2 and 3, whose images have values from 21 and 31.
void WriteColor(const ScratchFolder& folder) {
  folder.Write("calib.txt", kColorCalibration);
  folder.Write("times.txt", "0\n0.1\n0.2\n");
  folder.Write("poses.txt",
               "1 0 0 0 0 1 0 0 0 0 1 0\n0 0 1 0 0 1 0 0 -1 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  for (const int i : {0, 1, 2}) {
    const std::string name = "/00000" + std::to_string(i) + ".png";
    folder.Write("image_2" + name, Png(1241, 376, i + 21));
    folder.Write("image_3" + name, Png(1241, 376, i + 31));
  }
}

TEST(KittiCalibration, ColoursAreUsedWhereThereIsNoGrey) {
  const ScratchFolder folder;
  WriteColor(folder);
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().format, DatasetFormat::kKitti);
  EXPECT_EQ(dataset->info().layout, "odometry, colour cameras 2 and 3");
  EXPECT_EQ(dataset->sensor(), SensorKind::kStereo);
  const auto frame = dataset->Read(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->left.at(3, 3), 22);
  EXPECT_EQ(frame->right->at(3, 3), 32);
  // Ground truth is of camera 0. In the second pose it looks along x of the world, and camera 2
  // stands 6 cm to its left: at z = 1.06.
  const auto& truth = dataset->info().ground_truth;
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->frame, GroundTruth::Frame::kBody);
  const Eigen::Vector3d place =
      truth->OfCamera(dataset->calibration())[1].world_from_camera.translation;
  EXPECT_NEAR(place.z(), 1 + (45.38225 - 607.1928 * 0.003779761) / 718.856, 1e-12);
  EXPECT_EQ(OpenDataset(folder.path(), {.sensor = SensorKind::kMono})->info().layout,
            "odometry, colour camera 2");
  folder.Write("image_0/000000.png", Png(1241, 376, 1));
  folder.Write("image_1/000000.png", Png(1241, 376, 11));
  const auto grey = OpenDataset(folder.path());
  EXPECT_EQ(grey->info().layout, "odometry, grey cameras 0 and 1");
  EXPECT_EQ(grey->Read(0)->right->at(0, 0), 11);
}

TEST(KittiCalibration, AnotherCameraKeepsThePlaceOfCameraTwo) {
  const ScratchFolder folder;
  WriteColor(folder);
  const auto camera =
      folder.Write("own/camera.yaml", "size: [1241, 376]\nintrinsics: [700, 700, 600, 180]\n");
  const DatasetOptions options = {.sensor = SensorKind::kMono, .camera = camera.string()};
  const auto dataset = OpenDataset(folder.path(), options);
  ASSERT_TRUE(dataset->calibration().body_from_left);
  EXPECT_NEAR(dataset->calibration().body_from_left->translation.x(), -0.05994, 1e-5);
  EXPECT_TRUE(dataset->info().ground_truth);
  fs::remove(folder / "calib.txt");
  const auto alone = OpenDataset(folder.path(), options);
  EXPECT_FALSE(alone->info().ground_truth);
  EXPECT_THAT(alone->info().ground_truth_fault.value_or(""), HasSubstr("expected body_from_left"));
}

// As in calib_cam_to_cam.txt of 2011_09_26, with smaller images: cameras turned by 90 degrees at
// most would be no pair, so they are turned a little.
const std::string kRawCalibration =
    "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n"
    "S_00: 14 10\nK_00: 10 0 7 0 11 5 0 0 1\nD_00: -0.3 0.2 0.001 0.002 -0.05\n"
    "R_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\n"
    "S_rect_00: 12 8\nR_rect_00: 0.8 -0.6 0 0.6 0.8 0 0 0 1\n"
    "P_rect_00: 9 0 6 0 0 9 4 0 0 0 1 0\n"
    "S_01: 14 10\nK_01: 10.5 0 7 0 11 5 0 0 1\nD_01: -0.3 0.2 0 0 0\n"
    "R_01: 1 0 0 0 1 0 0 0 1\nT_01: -0.5 0.01 0.02\n"
    "S_rect_01: 12 8\nR_rect_01: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_01: 9 0 6 -4.5 0 9 4 0 0 0 1 0\n"
    "S_02: 14 10\nK_02: 10 0 7 0 11 5 0 0 1\nD_02: -0.3 0.2 0 0 0\n"
    "R_02: 1 0 0 0 1 0 0 0 1\nT_02: 0.06 0 0.01\n"
    "S_rect_02: 12 8\nR_rect_02: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_02: 9 0 6 0.54 0 9 4 0 0 0 1 0\n"
    "S_03: 14 10\nK_03: 10 0 7 0 11 5 0 0 1\nD_03: -0.3 0.2 0 0 0\n"
    "R_03: 1 0 0 0 1 0 0 0 1\nT_03: -0.47 0 0.01\n"
    "S_rect_03: 12 8\nR_rect_03: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_03: 9 0 6 -4.23 0 9 4 0 0 0 1 0\n";

const std::string kDrive = "2011_09_26/2011_09_26_drive_0001";

// Three pairs of a drive; the value of the first left image is 10 times its camera.
fs::path WriteDrive(const ScratchFolder& folder,
                    const std::string& kind,
                    const std::vector<int>& cameras,
                    ImageSize size) {
  folder.Write("2011_09_26/calib_cam_to_cam.txt", kRawCalibration);
  const std::string drive = kDrive + kind;
  for (const int camera : cameras) {
    const std::string name = drive + "/image_0" + std::to_string(camera);
    folder.Write(name + "/timestamps.txt",
                 "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074343777\n"
                 "2011-09-26 13:02:26.174598360\n");
    for (const int i : {0, 1, 2}) {
      folder.Write(name + "/data/000000000" + std::to_string(i) + ".png",
                   Png(size.width, size.height, 10 * camera + i));
    }
  }
  return folder / drive;
}

TEST(KittiRaw, ReadsRectifiedDrives) {
  const ScratchFolder folder;
  const fs::path drive = WriteDrive(folder, "_sync", {0, 1, 2, 3}, {12, 8});
  const auto dataset = OpenDataset(drive);
  EXPECT_EQ(dataset->info().format, DatasetFormat::kKitti);
  EXPECT_EQ(dataset->info().layout, "raw, rectified, grey cameras 0 and 1");
  EXPECT_THAT(dataset->info().calibration_source, EndsWith("(KITTI calib_cam_to_cam.txt)"));
  // date -u -d '2011-09-26 13:02:25' +%s
  EXPECT_THAT(
      dataset->info().stamps_ns,
      ElementsAre(1'317'042'145'964'389'445, 1'317'042'146'074'343'777, 1'317'042'146'174'598'360));
  EXPECT_TRUE(dataset->calibration().rectified);
  EXPECT_EQ(dataset->calibration().left.intrinsics().cx, 6);
  EXPECT_EQ(dataset->calibration().right_from_left.translation, Eigen::Vector3d(-0.5, 0, 0));
  EXPECT_FALSE(dataset->calibration().body_from_left);
  EXPECT_EQ(dataset->Read(2)->right->at(0, 0), 12);
  EXPECT_FALSE(dataset->info().ground_truth_fault);
}

TEST(KittiRaw, ReadsColoursAndACalibrationInTheDrive) {
  const ScratchFolder folder;
  const fs::path drive = WriteDrive(folder, "_sync", {2, 3}, {12, 8});
  fs::rename(folder / "2011_09_26/calib_cam_to_cam.txt", drive / "calib_cam_to_cam.txt");
  const auto dataset = OpenDataset(drive);
  EXPECT_EQ(dataset->info().layout, "raw, rectified, colour cameras 2 and 3");
  EXPECT_TRUE(dataset->calibration().rectified);
  EXPECT_NEAR(dataset->calibration().right_from_left.translation.x(), -0.53, 1e-12);
  EXPECT_NEAR(dataset->calibration().body_from_left->translation.x(), -0.06, 1e-12);
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 20);
}

TEST(KittiRaw, ReadsDrivesAsTaken) {
  const ScratchFolder folder;
  const fs::path drive = WriteDrive(folder, "_extract", {0, 1}, {14, 10});
  const auto dataset = OpenDataset(drive);
  EXPECT_EQ(dataset->info().layout, "raw, as taken, grey cameras 0 and 1");
  const Calibration& c = dataset->calibration();
  EXPECT_FALSE(c.rectified);
  const CameraIntrinsics& left = c.left.intrinsics();
  EXPECT_EQ(left.model, DistortionModel::kRadTan);
  EXPECT_THAT(left.distortion, ElementsAre(-0.3, 0.2, 0.001, 0.002, -0.05, 0, 0, 0));
  EXPECT_THAT((std::vector{left.fx, left.fy, left.cx, left.cy}), ElementsAre(10, 11, 7, 5));
  EXPECT_EQ(c.right->intrinsics().fx, 10.5);
  EXPECT_EQ(c.right_from_left.translation, Eigen::Vector3d(-0.5, 0.01, 0.02));
  // Poses of KITTI are of the rectified camera 0, which is turned by R_rect_00.
  EXPECT_LT((*c.body_from_left * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0.8, 0.6, 0)).norm(),
            1e-12);
  const ScratchFolder other;
  const auto color = OpenDataset(WriteDrive(other, "_extract", {2, 3}, {14, 10}));
  EXPECT_LT(
      (color->calibration().right_from_left.translation - Eigen::Vector3d(-0.53, 0, 0)).norm(),
      1e-12);
}

// The sizes tell what the images are, whatever the folder is called; the name where they cannot.
TEST(KittiRaw, TheNameOfTheDriveCountsWhereTheSizesAreTheSame) {
  const ScratchFolder folder;
  const fs::path drive = WriteDrive(folder, "_extract", {0, 1}, {12, 8});
  EXPECT_TRUE(OpenDataset(drive)->calibration().rectified);
  std::string same = kRawCalibration;
  for (auto at = same.find(": 14 10"); at != std::string::npos; at = same.find(": 14 10")) {
    same.replace(at, 7, ": 12 8");
  }
  folder.Write("2011_09_26/calib_cam_to_cam.txt", same);
  EXPECT_FALSE(OpenDataset(drive)->calibration().rectified);
}

TEST(KittiRaw, TimesThatRepeatLoseTheirImage) {
  const ScratchFolder folder;
  const fs::path drive = WriteDrive(folder, "_sync", {0, 1}, {12, 8});
  folder.Write(kDrive + "_sync/image_00/timestamps.txt",
               "2011-09-26 13:02:26\n2011-09-26 13:02:26.000\n2011-09-26 13:02:25.5\n");
  const auto dataset = OpenDataset(drive);
  EXPECT_THAT(dataset->info().stamps_ns,
              ElementsAre(1'317'042'145'500'000'000, 1'317'042'146'000'000'000));
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 2);
  EXPECT_EQ(dataset->Read(1)->left.at(0, 0), 0);
}

TEST(KittiRaw, NamesFaults) {
  struct Case {
    std::string file;
    std::string from, to;  // in that file; empty: the file goes
    std::string message;
  };
  const std::string calibration = "2011_09_26/calib_cam_to_cam.txt";
  const std::string times = kDrive + "_sync/image_00/timestamps.txt";
  const std::vector<Case> cases = {
      {calibration, "", "", "expected calib_cam_to_cam.txt in this folder or the one around it"},
      {calibration, "S_rect_00: 12 8", "S_rect_00: 13 8", "expected the size of the images, 12x8"},
      {calibration, "P_rect_01:", "P_rect_09:", "expected a row 'P_rect_01:', found none"},
      {calibration, "P_rect_00: 9 0", "P_rect_00: 9 1", "the projection of a rectified camera"},
      {calibration,
       "P_rect_01: 9 0 6 -4.5",
       "P_rect_01: 9 0 6 4.5",
       "expected P_rect_01 to be P_rect_00 with a baseline above 0, found a baseline of -0.5 m"},
      {times, "", "", "timestamps.txt: no such file"},
      {times, "13:02:26.07", "25:02:26.07", "timestamps.txt:2: expected a date and a time such as"},
      {times, "2011-09-26 13:02:25", "2011-02-30 13:02:25", "timestamps.txt:1: expected a date"},
      {times,
       "\n2011-09-26 13:02:26.174598360",
       "",
       "timestamps.txt: expected a time for each image up to 0000000002.png, found 2 times"}};
  for (const Case& c : cases) {
    const ScratchFolder folder;
    const fs::path drive = WriteDrive(folder, "_sync", {0, 1}, {12, 8});
    std::string text = Contents(folder / c.file);
    if (c.from.empty()) {
      fs::remove(folder / c.file);
    } else {
      ASSERT_NE(text.find(c.from), std::string::npos) << c.from;
      folder.Write(c.file, text.replace(text.find(c.from), c.from.size(), c.to));
    }
    EXPECT_THAT(MessageOf([&] { OpenDataset(drive, {.format = DatasetFormat::kKitti}); }),
                HasSubstr(c.message))
        << c.message;
  }
}

}  // namespace
}  // namespace plumbline
