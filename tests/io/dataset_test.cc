// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/dataset.h"

#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include "tests/support/euroc_calibration.h"
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(OpenDataset, ReadsEurocAsStereoAndAsMono) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().format, DatasetFormat::kEuroc);
  EXPECT_EQ(dataset->sensor(), SensorKind::kStereo);
  EXPECT_THAT(dataset->info().available, ElementsAre(SensorKind::kStereo, SensorKind::kMono));
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(100, 200, 300));
  EXPECT_THAT(dataset->info().notes, IsEmpty());
  EXPECT_NEAR(dataset->calibration().right_from_left.translation.x(), -0.1, 1e-15);
  const auto frame = dataset->Read(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp_ns, 200);
  EXPECT_EQ(frame->left.at(0, 0), 2);
  EXPECT_EQ(frame->right->at(0, 0), 12);
  EXPECT_FALSE(frame->depth);

  const auto mono = OpenDataset(folder / "mav0", {.sensor = SensorKind::kMono});
  EXPECT_FALSE(mono->calibration().right);
  EXPECT_FALSE(mono->Read(0)->right);
}

TEST(OpenDataset, TurnsGroundTruthOfTheBodyIntoTheCameras) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  const auto dataset = OpenDataset(folder.path());
  ASSERT_TRUE(dataset->info().ground_truth);
  const GroundTruth& truth = *dataset->info().ground_truth;
  EXPECT_EQ(truth.frame, GroundTruth::Frame::kBody);
  EXPECT_EQ(truth.poses[0].world_from_camera.translation, Eigen::Vector3d(1, 2, 3));
  // The body looks along world y after a quarter turn about z; the camera sits at x = 0.5 in it.
  const Trajectory camera = truth.OfCamera(dataset->calibration());
  EXPECT_LT((camera[0].world_from_camera.translation - Eigen::Vector3d(1, 2.5, 3)).norm(), 1e-12);
}

TEST(OpenDataset, LeavesOutEurocFramesWithoutTheirPair) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  folder.Write("mav0/cam1/data.csv", "#h\n100,1.png\n250,x.png\n300,3.png\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(100, 300));
  EXPECT_THAT(dataset->info().notes,
              ElementsAre("1 left images without a right one are left out",
                          "1 right images without a left one are left out"));
}

TEST(OpenDataset, MissingImageFilesFailFrameByFrame) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  std::filesystem::remove(folder / "mav0/cam0/data/2.png");
  folder.Write("mav0/cam1/data/3.png", "broken");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_THAT(dataset->info().notes, ElementsAre("1 of 3 left images do not exist"));
  EXPECT_EQ(dataset->size(), 3U);
  EXPECT_TRUE(dataset->Read(0));
  EXPECT_EQ(dataset->Read(1).error().path, folder / "mav0/cam0/data/2.png");
  EXPECT_EQ(dataset->Read(1).error().why, "no such file");
  EXPECT_EQ(dataset->Read(2).error().path, folder / "mav0/cam1/data/3.png");
  // In mono only the left image counts.
  EXPECT_TRUE(OpenDataset(folder.path(), {.sensor = SensorKind::kMono})->Read(2));
}

TEST(OpenDataset, ACameraFileInTheFolderGoesFirst) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  EXPECT_THAT(OpenDataset(folder.path())->info().calibration_source,
              HasSubstr("cam0/sensor.yaml and that of cam1 (EuRoC sensor.yaml)"));
  const std::string camera =
      "  camera_model: pinhole\n  intrinsics: [7, 7, 4, 3]\n  resolution: [8, 6]\n"
      "  distortion_model: none\n";
  const auto file = folder.Write("camchain.yaml", "cam0:\n" + camera);
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path()); }),
              HasSubstr("camchain.yaml: expected a stereo camera, found one camera"));
  folder.Write("camchain.yaml",
               "cam0:\n" + camera + "cam1:\n" + camera +
                   "  T_cn_cnm1: [[1, 0, 0, -0.3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().calibration_source, file.string() + " (Kalibr camchain)");
  EXPECT_EQ(dataset->calibration().left.intrinsics().fx, 7);
  EXPECT_EQ(dataset->calibration().right_from_left.translation.x(), -0.3);
  // The body of the ground truth is that of the data.
  EXPECT_EQ(dataset->calibration().body_from_left->translation.x(), 0.5);
}

TEST(OpenDataset, GroundTruthOfABodyNeedsItsPlace) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  for (const char* sensor : {"cam0/sensor.yaml", "cam1/sensor.yaml"}) {
    std::filesystem::remove(folder / ("mav0/" + std::string(sensor)));
  }
  folder.Write("camera.yaml",
               "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrectified: true\nbaseline: 0.1\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_FALSE(dataset->info().ground_truth);
  EXPECT_THAT(
      dataset->info().ground_truth_fault.value_or(""),
      EndsWith("state_groundtruth_estimate0/data.csv: expected body_from_left in the camera "
               "file, since these are poses of a body, found none"));
}

// One of them is a broken image; where there are no others, the calibration is wrong.
TEST(OpenDataset, RefusesACalibrationOfAnotherSizeButNotAnImage) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  folder.Write("mav0/cam0/data/2.png", Png(9, 6, 1));
  const auto dataset = OpenDataset(folder.path());
  const ImageFailure failure = dataset->Read(1).error();
  EXPECT_EQ(failure.path.filename(), "2.png");
  EXPECT_EQ(failure.why, "expected an image of 8x6 pixels as in the calibration, found 9x6");
  EXPECT_STREQ(failure.reason(), "image_size");
  folder.Write("mav0/cam0/data/2.png", Png(8, 6, 1));
  folder.Write("mav0/cam1/data/1.png", Png(8, 7, 1));
  EXPECT_EQ(OpenDataset(folder.path())->Read(0).error().path.filename(), "1.png");
  for (const auto& image : std::filesystem::directory_iterator(folder / "mav0/cam1/data")) {
    std::ofstream(image.path(), std::ios::binary) << Png(8, 7, 1);
  }
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path()); }),
              HasSubstr("cam1/data/1.png: expected an image of 8x6 pixels as in the calibration"));
}

TEST(OpenDataset, ReadsKitti) {
  const ScratchFolder folder;
  WriteKitti(folder);
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().format, DatasetFormat::kKitti);
  EXPECT_EQ(dataset->sensor(), SensorKind::kStereo);
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(0, 103'700'000, 207'400'000));
  const Calibration& c = dataset->calibration();
  EXPECT_TRUE(c.rectified);
  EXPECT_EQ(c.left.width(), 8);
  EXPECT_EQ(c.left.intrinsics().fy, 710);
  EXPECT_NEAR(c.right_from_left.translation.x(), -380.0 / 700, 1e-15);
  EXPECT_EQ(dataset->Read(2)->right->at(3, 3), 13);
  ASSERT_TRUE(dataset->info().ground_truth);
  EXPECT_EQ(dataset->info().ground_truth->frame, GroundTruth::Frame::kCamera);
  EXPECT_EQ(dataset->info().ground_truth->poses.size(), 3U);
}

TEST(OpenDataset, KittiGapsInTheImagesFailFrameByFrame) {
  const ScratchFolder folder;
  WriteKitti(folder);
  std::filesystem::remove(folder / "image_1/000001.png");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->size(), 3U);
  EXPECT_THAT(dataset->info().notes, ElementsAre("1 of 3 right images do not exist"));
  EXPECT_FALSE(dataset->Read(1));
  EXPECT_EQ(dataset->Read(2)->left.at(0, 0), 3);
}

TEST(OpenDataset, JoinsTumDepthNearestInTime) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().format, DatasetFormat::kTum);
  EXPECT_EQ(dataset->sensor(), SensorKind::kRgbd);
  // 1.000 has depth at 1.010; 1.033 has none of its own (1.010 is nearer to 1.000); 1.100 has
  // 1.081, but 1.200 is 21 ms off.
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(1'000'000'000, 1'100'000'000));
  EXPECT_THAT(dataset->info().notes,
              ElementsAre("2 colour images without depth within 20 ms are left out"));
  const auto frame = dataset->Read(1);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->left.at(0, 0), 3);
  EXPECT_EQ(frame->depth->at(0, 0), 2.0F);

  const auto mono = OpenDataset(folder.path(), {.sensor = SensorKind::kMono});
  EXPECT_EQ(mono->size(), 4U);
  EXPECT_FALSE(mono->calibration().depth_factor);
}

// The left list has 200 twice, the right one has 300 before 200: pairs stay pairs.
TEST(OpenDataset, EurocListsAreSortedAndHaveEachTimeOnce) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  folder.Write("mav0/cam0/data.csv", "#h\n100,1.png\n200,2.png\n200,3.png\n300,3.png\n");
  folder.Write("mav0/cam1/data.csv", "#h\n100,1.png\n300,3.png\n200,2.png\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(100, 200, 300));
  EXPECT_THAT(dataset->info().notes,
              ElementsAre(EndsWith("cam0/data.csv:4: 1 row repeats a time stamp and is left out"),
                          EndsWith("cam1/data.csv:4: 1 row goes back in time and is sorted in")));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto frame = dataset->Read(i);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->left.at(0, 0), i + 1);
    EXPECT_EQ(frame->right->at(0, 0), i + 11);
  }
}

TEST(OpenDataset, TumListsAreSortedAndHaveEachTimeOnce) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  folder.Write("rgb.txt", "1.2 rgb/4.png\n1.0 rgb/1.png\n1.1 rgb/3.png\n1.1 rgb/2.png\n");
  folder.Write("depth.txt", "1.201 depth/3.png\n1.001 depth/1.png\n1.101 depth/2.png\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->sensor(), SensorKind::kRgbd);
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(1'000'000'000, 1'100'000'000, 1'200'000'000));
  EXPECT_THAT(
      dataset->info().notes,
      ElementsAre(
          EndsWith("rgb.txt:4: 1 row repeats a time stamp and is left out"),
          EndsWith("rgb.txt:2: 2 rows go back in time and are sorted in, this one first"),
          EndsWith("depth.txt:2: 2 rows go back in time and are sorted in, this one first")));
  for (const auto& [i, value, metres] :
       {std::tuple(0U, 1, 1.0F), std::tuple(1U, 3, 2.0F), std::tuple(2U, 4, 3.0F)}) {
    const auto frame = dataset->Read(i);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->left.at(0, 0), value);
    EXPECT_EQ(frame->depth->at(0, 0), metres);
  }
}

// Images and poses of KITTI belong to rows of times.txt.
TEST(OpenDataset, KittiImagesAndPosesFollowTheirTimes) {
  const ScratchFolder folder;
  WriteKitti(folder);
  folder.Write("times.txt", "0.2\n0.1\n0.2\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(100'000'000, 200'000'000));
  EXPECT_THAT(dataset->info().notes,
              ElementsAre(EndsWith("times.txt:3: 1 row repeats a time stamp and is left out"),
                          EndsWith("times.txt:2: 1 row goes back in time and is sorted in")));
  const Trajectory& truth = dataset->info().ground_truth->poses;
  ASSERT_EQ(truth.size(), 2U);
  for (const auto& [i, row] : {std::pair(0U, 1), std::pair(1U, 0)}) {
    const auto frame = dataset->Read(i);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->left.at(0, 0), row + 1);
    EXPECT_EQ(frame->right->at(0, 0), row + 11);
    EXPECT_EQ(truth[i].stamp_ns, dataset->stamp_ns(i));
    EXPECT_EQ(truth[i].world_from_camera.translation.z(), row);
  }
}

TEST(OpenDataset, FindsTheCameraOfATumFolderByItsName) {
  const ScratchFolder folder;
  folder.Write("rgbd_dataset_freiburg3_x/rgb.txt", "1.0 a.png\n");
  folder.Write("rgbd_dataset_freiburg3_x/a.png", Png(640, 480, 1));
  const auto dataset = OpenDataset(folder / "rgbd_dataset_freiburg3_x/");
  EXPECT_EQ(dataset->info().name, "rgbd_dataset_freiburg3_x");
  EXPECT_EQ(dataset->calibration().left.intrinsics().fx, 535.4);
  EXPECT_EQ(dataset->sensor(), SensorKind::kMono);
  EXPECT_TRUE(dataset->Read(0));
}

TEST(OpenDataset, SortsFoldersOfImagesByNumber) {
  const ScratchFolder folder;
  for (const int i : {1, 2, 10}) {
    folder.Write("img" + std::to_string(i) + ".png", Png(8, 6, i));
  }
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->info().format, DatasetFormat::kImages);
  EXPECT_THAT(dataset->info().stamps_ns, ElementsAre(0, 333'333'333, 666'666'667));
  EXPECT_EQ(dataset->Read(1)->left.at(0, 0), 2);
  EXPECT_EQ(dataset->Read(2)->left.at(0, 0), 10);
}

// Returns the order of images, each of which shows its place in the list.
std::vector<int> OrderOf(const std::vector<std::string>& names) {
  const ScratchFolder folder;
  for (std::size_t i = 0; i < names.size(); ++i) {
    folder.Write(names[i] + ".png", Png(8, 6, static_cast<int>(i)));
  }
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  const auto dataset = OpenDataset(folder.path());
  std::vector<int> order;
  for (std::size_t i = 0; i < dataset->size(); ++i) {
    order.push_back(dataset->Read(i)->left.at(0, 0));
  }
  return order;
}

// Seconds without zeros at their end are fractions. What counts on behind a point, or has zeros at
// the end of all its fractions, is in the order of whole numbers.
TEST(OpenDataset, SortsFoldersOfImagesByDecimalSeconds) {
  EXPECT_THAT(OrderOf({"0.0", "0.05", "0.1", "0.15", "1.0", "1.5", "10.25"}),
              ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(OrderOf({"a9.5_l", "a10.05_l", "a10.1_l"}), ElementsAre(0, 1, 2));
  EXPECT_THAT(OrderOf({"cam1.8", "cam1.9", "cam1.10", "cam1.11", "cam2.1"}),
              ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(OrderOf({"0.050", "0.100", "0.150", "1.000"}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(OrderOf({"1.2.3", "1.2.14", "1.15.1"}), ElementsAre(0, 1, 2));
}

// macOS leaves a hidden file beside each on disks of other systems.
TEST(OpenDataset, LeavesHiddenFilesOut) {
  const ScratchFolder folder, numbered;
  for (const char* name : {"1.png", "2.png"}) folder.Write(name, Png(8, 6, 7));
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  for (const char* name : {"._1.png", "._2.png", ".png"}) folder.Write(name, "Mac OS X");
  EXPECT_EQ(OpenDataset(folder.path())->size(), 2U);
  WriteKitti(numbered);
  numbered.Write("image_0/._000001.png", "Mac OS X");
  EXPECT_EQ(OpenDataset(numbered.path())->size(), 3U);
}

TEST(OpenDataset, TellsOfImagesOf16Bits) {
  const ScratchFolder folder;
  for (const char* name : {"1.png", "2.png"}) folder.Write(name, Png(8, 6, 4095));
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_THAT(dataset->info().notes,
              ElementsAre("the images have 16 bits, of which the upper 8 are used: the brightest "
                          "level of the first one, 4095 of 65535, becomes 15 of 255"));
  EXPECT_EQ(dataset->Read(0)->left.at(0, 0), 15);
}

TEST(OpenDataset, LooksAtDataWithoutCalibrationOnRequest) {
  const ScratchFolder folder;
  folder.Write("rgb.txt", "1.0 a.png\n");
  folder.Write("a.png", Png(8, 6, 9));
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path()); }), HasSubstr("give --camera FILE"));
  const auto dataset = OpenDataset(folder.path(), {.allow_missing_camera = true});
  EXPECT_FALSE(dataset->info().has_calibration);
  EXPECT_TRUE(dataset->Read(0));
}

struct RealCase {
  std::string folder;
  std::string camera;
  SensorKind sensor;
  std::size_t frames;
};

TEST(OpenDataset, OpensTheRealSequences) {
  const std::vector<RealCase> cases = {
      {"euroc/MH_01_easy_first250", "", SensorKind::kStereo, 250},
      {"icl/office_kt3_first600", "icl_nuim", SensorKind::kMono, 600},
      {"kitti/06_first51", "", SensorKind::kStereo, 51},
      {"tum/rgbd_dataset_freiburg1_floor_first90", "", SensorKind::kRgbd, 90},
  };
  for (const RealCase& c : cases) {
    const auto path = FindData(c.folder);
    if (!path) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    DatasetOptions options;
    if (!c.camera.empty()) options.camera = c.camera;
    const auto dataset = OpenDataset(*path, options);
    EXPECT_EQ(dataset->size(), c.frames) << c.folder;
    EXPECT_EQ(dataset->sensor(), c.sensor) << c.folder;
    EXPECT_THAT(dataset->info().notes, IsEmpty()) << c.folder;
    EXPECT_TRUE(dataset->info().ground_truth) << c.folder;
    EXPECT_TRUE(dataset->Read(0)) << c.folder;
    EXPECT_TRUE(dataset->Read(c.frames - 1)) << c.folder;
  }
}

TEST(OpenDataset, FindsExactlyOneBadPairInEuroc) {
  const auto path = FindData("euroc/MH_01_easy_first250");
  if (!path) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const auto dataset = OpenDataset(*path);
  EXPECT_LT(
      LogSe3(dataset->calibration().right_from_left * Inverse(EurocCalibration().right_from_left))
          .norm(),
      1e-14);
  std::vector<std::int64_t> bad;
  for (std::size_t i = 155; i < 170; ++i) {
    if (!dataset->Read(i)) bad.push_back(dataset->stamp_ns(i));
  }
  EXPECT_THAT(bad, ElementsAre(1403636592913555456));
}

}  // namespace
}  // namespace plumbline
