// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/frame_preparation.h"

#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/euroc_calibration.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReducedSize, IsAtMostTwoMegapixelsOrTheWidthAskedFor) {
  for (const ImageSize size : {ImageSize{1920, 1080}, {2048, 1024}, {1600, 1200}, {8, 6}}) {
    EXPECT_EQ(ReducedSize(size, std::nullopt), size);
  }
  EXPECT_EQ(ReducedSize({4000, 3000}, std::nullopt), (ImageSize{1672, 1254}));
  EXPECT_EQ(ReducedSize({3840, 2160}, std::nullopt), (ImageSize{1930, 1086}));
  EXPECT_EQ(ReducedSize({3000, 4000}, std::nullopt), (ImageSize{1254, 1672}));
  for (const ImageSize size : {ImageSize{1921, 1092}, {100'000, 999}, {3, 1'000'000}}) {
    const ImageSize reduced = ReducedSize(size, std::nullopt);
    EXPECT_LE(std::int64_t{reduced.width} * reduced.height, kMostPixelsByDefault);
    EXPECT_LE(reduced.width, size.width);
    EXPECT_LE(reduced.height, size.height);
    EXPECT_GT(std::int64_t{reduced.width} * reduced.height, kMostPixelsByDefault / 2);
  }
  EXPECT_EQ(ReducedSize({4000, 3000}, 800), (ImageSize{800, 600}));
  EXPECT_EQ(ReducedSize({4000, 3000}, 4000), (ImageSize{4000, 3000}));
  EXPECT_EQ(ReducedSize({640, 480}, 800), (ImageSize{640, 480}));
  EXPECT_THAT(MessageOf([] { ReducedSize({640, 480}, 0); }), HasSubstr("of 1 or more, found 0"));
}

Calibration PairOfCameras() {
  Calibration pair;
  pair.left = Camera({.fx = 500,
                      .fy = 510,
                      .cx = 300,
                      .cy = 220,
                      .width = 640,
                      .height = 401,
                      .model = DistortionModel::kRadTan,
                      .distortion = {-0.2, 0.05, 0.003, -0.002, 0}});
  pair.right = pair.left;
  pair.right_from_left.translation = {-0.1, 0, 0};
  return pair;
}

// What is seen at the border between two pixels stays there: it has half the coordinate, counted
// from the border of the image.
TEST(FramePreparation, ReducesTheCamerasWithTheImages) {
  const Calibration delivered = PairOfCameras();
  const FramePreparation preparation(delivered, {}, {.max_width = 320});
  const Calibration& used = preparation.calibration();
  EXPECT_EQ(used.left.height(), 201);
  const Eigen::Vector3d point(0.3, -0.2, 1.2);
  const Eigen::Vector2d before = *delivered.left.Project(point);
  const Eigen::Vector2d after = *used.left.Project(point);
  EXPECT_NEAR(after.x() + 0.5, (before.x() + 0.5) / 2, 1e-9);
  EXPECT_NEAR(after.y() + 0.5, (before.y() + 0.5) * 201 / 401, 1e-9);
  EXPECT_EQ(*used.right, used.left);
  EXPECT_EQ(used.right_from_left.translation, delivered.right_from_left.translation);
  EXPECT_TRUE(FramePreparation(delivered, {}, {.max_width = 640}).IsIdentity());
  EXPECT_TRUE(FramePreparation(delivered, {}, {}).IsIdentity());
  SensorFrame frame;
  frame.left = GrayImage(640, 401, 7);
  frame.right = GrayImage(640, 401, 9);
  frame = preparation.Apply(std::move(frame));
  EXPECT_EQ(frame.left.width(), 320);
  EXPECT_EQ(frame.right->height(), 201);
  EXPECT_EQ(frame.right->at(319, 200), 9);
}

TEST(FramePreparation, TurnsNoPair) {
  EXPECT_THAT(MessageOf([] { FramePreparation(PairOfCameras(), ClockwiseTurn(90), {}); }),
              HasSubstr("found a stereo pair, whose cameras would not lie side by side"));
  const ScratchFolder folder;
  WriteEuroc(folder);
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path(), {.rotate = Rotation::k180}); }),
              HasSubstr(folder.path().string() + ": expected one camera"));
  const auto mono =
      OpenDataset(folder.path(), {.sensor = SensorKind::kMono, .rotate = Rotation::k180});
  EXPECT_EQ(mono->Read(1)->left.at(3, 3), 2);
  EXPECT_THAT(mono->info().notes,
              testing::Contains("images are turned by 180 degrees clockwise, and the calibration "
                                "with them"));
}

// A camera turned about its axis is elsewhere in no way: its truth keeps its places and turns.
TEST(PreparedDataset, TurnsDepthAndGroundTruthWithTheImages) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  cv::Mat depth(6, 8, CV_16UC1, cv::Scalar(1000));
  depth.at<std::uint16_t>(0, 7) = 3000;
  cv::imwrite((folder / "depth/1.png").string(), depth);
  const auto stored = OpenDataset(folder.path());
  const auto turned = OpenDataset(folder.path(), {.rotate = Rotation::k90});
  const SensorFrame frame = *turned->Read(0);
  EXPECT_EQ(frame.left.width(), 6);
  EXPECT_EQ(frame.depth->at(5, 7), 3.0F);  // the upper right corner comes to the lower right
  EXPECT_EQ(frame.depth->at(0, 7), 1.0F);
  EXPECT_EQ(turned->calibration().left.intrinsics().cx, 6 - 1 - 3);
  const Rigid3& truth = turned->info().ground_truth->poses.front().world_from_camera;
  EXPECT_LT((truth.rotation * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_EQ(truth.translation,
            stored->info().ground_truth->poses.front().world_from_camera.translation);
  const auto reduced = OpenDataset(folder.path(), {.max_width = 4});
  EXPECT_EQ(reduced->Read(0)->depth->width(), 4);
  EXPECT_EQ(reduced->Read(0)->left.height(), 3);
  EXPECT_EQ(reduced->Read(0)->stamp_ns, stored->stamp_ns(0));
}

std::string MaskOf(int width, int height, int black_columns) {
  cv::Mat mask(height, width, CV_8UC1, cv::Scalar(255));
  mask.colRange(0, black_columns).setTo(0);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", mask, bytes);
  return {bytes.begin(), bytes.end()};
}

TEST(PreparedDataset, MasksAreTurnedAndReducedWithTheImages) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const std::string mask = folder.Write("mask.png", MaskOf(8, 6, 3)).string();
  EXPECT_EQ(OpenDataset(folder.path())->Read(0)->left_mask, nullptr);
  const auto frame = OpenDataset(folder.path(), {.masks = {mask}})->Read(0);
  ASSERT_TRUE(frame->left_mask);
  EXPECT_EQ(frame->left_mask->at(2, 1), 0);
  EXPECT_EQ(frame->left_mask->at(3, 1), 255);
  // The left side comes to the top.
  const auto turned = OpenDataset(folder.path(), {.rotate = Rotation::k90, .masks = {mask}});
  EXPECT_EQ(turned->Read(0)->left_mask->width(), 6);
  EXPECT_EQ(turned->Read(0)->left_mask->at(1, 2), 0);
  EXPECT_EQ(turned->Read(0)->left_mask->at(1, 3), 255);
  // A pixel of which a part is black is.
  const auto reduced = OpenDataset(folder.path(), {.max_width = 4, .masks = {mask}});
  EXPECT_EQ(reduced->Read(0)->left_mask->at(1, 1), 0);
  EXPECT_EQ(reduced->Read(0)->left_mask->at(2, 1), 255);
}

TEST(PreparedDataset, FramesMayHaveMasksOfTheirOwn) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  folder.Write("mask0/1.png", MaskOf(8, 6, 5));
  const std::string mask = folder.Write("mask.png", MaskOf(8, 6, 3)).string();
  const auto own = OpenDataset(folder.path());
  EXPECT_EQ(own->Read(0)->left_mask->at(4, 0), 0);
  EXPECT_EQ(own->Read(0)->left_mask->at(5, 0), 255);
  EXPECT_THAT(own->info().notes, testing::Contains(HasSubstr("images of the data has a mask in ")));
  const auto both = OpenDataset(folder.path(), {.masks = {mask}});
  EXPECT_EQ(both->Read(0)->left_mask->at(4, 0), 0);
  folder.Write("mask0/1.png", MaskOf(8, 6, 1));
  EXPECT_EQ(OpenDataset(folder.path(), {.masks = {mask}})->Read(0)->left_mask->at(2, 0), 0);
}

TEST(PreparedDataset, TellsTheShareThatAMaskLeavesOut) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const auto notes = [&](int black_columns) {
    const std::string mask = folder.Write("mask.png", MaskOf(8, 6, black_columns)).string();
    return OpenDataset(folder.path(), {.masks = {mask}})->info().notes;
  };
  EXPECT_THAT(notes(2), testing::Contains(testing::EndsWith("leaves out 25 % of the image")));
  EXPECT_THAT(notes(6), testing::Contains(HasSubstr("75 % of the image; is it inverted?")));
  EXPECT_THAT(notes(0), testing::Contains(HasSubstr("nothing in it is black")));
  EXPECT_THAT(MessageOf([&] { notes(8); }), HasSubstr("mask.png: expected a mask with pixels"));
}

TEST(PreparedDataset, ABadMaskOfAFrameCostsTheMaskAlone) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  for (const std::string& bad : {std::string("text"), MaskOf(9, 6, 1)}) {
    folder.Write("mask0/1.png", bad);
    const auto dataset = OpenDataset(folder.path());
    ASSERT_TRUE(dataset->Read(0));
    EXPECT_EQ(dataset->Read(0)->left_mask, nullptr);
    EXPECT_THAT(dataset->info().notes,
                testing::Contains(testing::AllOf(HasSubstr("mask0/1.png: "),
                                                 HasSubstr("this mask cannot be used"))));
  }
}

TEST(PreparedDataset, TellsWhatMasksOfFramesLeaveOut) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const auto notes = [&](const std::string& mask) {
    folder.Write("mask0/1.png", mask);
    const auto dataset = OpenDataset(folder.path());
    EXPECT_TRUE(dataset->Read(0));
    return dataset->info().notes;
  };
  EXPECT_THAT(notes(MaskOf(8, 6, 2)),
              testing::Contains(
                  testing::AllOf(HasSubstr("1 of the "),
                                 HasSubstr(" images of the data has a mask in "),
                                 testing::EndsWith("mask0; it leaves out 25 % of the image"))));
  EXPECT_THAT(notes(MaskOf(8, 6, 8)), testing::Contains(HasSubstr("100 % of the image; is it")));
  folder.Write("mav0/mask0/1.png", MaskOf(8, 6, 4));
  EXPECT_THAT(OpenDataset(folder.path(), {.format = DatasetFormat::kTum})->info().notes,
              testing::Contains(HasSubstr("mav0/mask0 is not used, since there is ")));
  std::filesystem::remove_all(folder / "mav0");
  std::filesystem::remove_all(folder / "mask0");
  for (const char* name : {"mask0.png", "mask0"}) {
    folder.Write(name, MaskOf(8, 6, 2));
    EXPECT_THAT(OpenDataset(folder.path())->info().notes,
                testing::Contains(testing::AllOf(HasSubstr((folder / name).string() + " is not"),
                                                 HasSubstr("--mask"))));
    std::filesystem::remove(folder / name);
  }
}

TEST(FramePreparation, TellsThatOneMaskOfAPairIsOfTheLeftCamera) {
  const ScratchFolder folder;
  Calibration pair = EurocCalibration();
  const std::string mask = folder.Write("mask.png", MaskOf(752, 480, 3)).string();
  const auto notes = [&](const std::vector<std::string>& masks) {
    return FramePreparation(pair, {}, {.masks = masks}).MaskNotes();
  };
  EXPECT_THAT(notes({mask}), testing::Contains(HasSubstr("--mask is of the left camera")));
  EXPECT_THAT(notes({mask, mask}), testing::Not(testing::Contains(HasSubstr("left camera"))));
  pair.right.reset();
  EXPECT_THAT(notes({mask}), testing::Not(testing::Contains(HasSubstr("left camera"))));
}

TEST(PreparedDataset, SaysWhatIsWrongWithAMask) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const auto message = [&](const std::vector<std::string>& masks) {
    return MessageOf([&] { OpenDataset(folder.path(), {.masks = masks}); });
  };
  EXPECT_THAT(message({folder.Write("wide.png", MaskOf(9, 6, 1)).string()}),
              HasSubstr("wide.png: expected a mask of 8x6 pixels as the images, found 9x6"));
  EXPECT_THAT(message({(folder / "none.png").string()}), HasSubstr("none.png: no such file"));
  EXPECT_THAT(message({"/people/mask"}), HasSubstr("no such file, nor are there topics"));
  EXPECT_THAT(message({folder.Write("text.png", "text").string()}), HasSubstr("text.png: "));
  const std::string mask = folder.Write("mask.png", MaskOf(8, 6, 3)).string();
  EXPECT_THAT(message({mask, mask}),
              HasSubstr("expected at most 1 mask, one for each camera, found 2"));
}

// A JPEG file whose EXIF data ask for an orientation.
std::string JpegOf(const cv::Mat& image, int orientation) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes);
  std::string exif(
      "\xFF\xE1\0\x22"
      "Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0",
      28);
  exif += static_cast<char>(orientation);
  exif += std::string(7, '\0');
  std::string file(bytes.begin(), bytes.end());
  // Only two bytes stand before: "start of image".
  return file.insert(2, exif.substr(0, 36));
}

cv::Mat Gradient() {
  cv::Mat image(40, 60, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(3 * x + (y > 20 ? 60 : 0));
    }
  }
  return image;
}

constexpr char kStoredCamera[] = "size: [60, 40]\nintrinsics: [50, 51, 25, 18]\nrate_hz: 10\n";

// OpenCV turns images as their EXIF data ask.
TEST(ImageFolder, IsTurnedAsExifAsks) {
  for (int exif = 1; exif <= 8; ++exif) {
    const ScratchFolder folder;
    folder.Write("camera.yaml", kStoredCamera);
    const std::filesystem::path file = folder.Write("0.jpg", JpegOf(Gradient(), exif));
    const cv::Mat expected = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    const auto dataset = OpenDataset(folder.path());
    const GrayImage image = dataset->Read(0)->left;
    ASSERT_EQ(image.width(), expected.cols) << exif;
    EXPECT_EQ(cv::norm(AsMat(image), expected, cv::NORM_INF), 0) << exif;
    const Orientation orientation = OrientationOfExif(exif);
    EXPECT_EQ(dataset->calibration().left,
              Turned(OpenDataset(folder.path(), {.rotate = Rotation::kNone})->calibration().left,
                     orientation));
    if (exif == 1) {
      EXPECT_THAT(dataset->info().notes, testing::IsEmpty());
      continue;
    }
    EXPECT_THAT(dataset->info().notes,
                ElementsAre("images are " + Describe(orientation) +
                            " as the file asks, and the calibration with them"));
  }
}

// A phone that is turned between two pictures notes another orientation, while its lens stays.
TEST(ImageFolder, IsTurnedAsItsFirstImage) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kStoredCamera);
  folder.Write("0.jpg", "no image");
  folder.Write("1.jpg", JpegOf(Gradient(), 6));
  folder.Write("2.jpg", JpegOf(Gradient(), 1));
  const auto dataset = OpenDataset(folder.path());
  EXPECT_EQ(dataset->Read(1)->left.width(), 40);
  EXPECT_EQ(dataset->Read(2)->left.width(), 40);
  EXPECT_THAT(dataset->info().notes,
              testing::Contains(HasSubstr("2 of 3 images ask for another orientation")));
  folder.Write("camera.yaml", "size: [40, 60]\nintrinsics: [51, 50, 21, 25]\nrate_hz: 10\n");
  EXPECT_EQ(OpenDataset(folder.path())->calibration().left.intrinsics().cx, 21);
}

}  // namespace
}  // namespace plumbline
