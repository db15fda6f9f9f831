// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// What of recordings is refused, and what the messages say.
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/recorded_bag.h"
#include "tests/io/scratch_folder.h"
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

TEST(RecordedErrors, SayThat16BitsAloneMayBeDepth) {
  const ScratchFolder folder;
  const auto path = Write(folder, DeepBag({"/ir/image"}, {2000}));
  EXPECT_THAT(MessageOf([&] { OpenDataset(path, {.camera = PairFile(folder)}); }),
              HasSubstr("expected an image beside what may be depth, found /ir/image (mono16, 1 "
                        "images); --topic NAME takes a topic of 16 bits for images"));
}

TEST(RecordedErrors, ListTopicsWhereTheChoiceIsNotClear) {
  const ScratchFolder folder;
  BagWriter bag;
  AddImage(bag, "/front/image", Gray(kSecond, 'a'));
  AddImage(bag, "/back/image", Gray(kSecond, 'b'));
  const auto path = Write(folder, bag);
  const std::string camera = PairFile(folder);
  const auto message = [&](const DatasetOptions& options) {
    return MessageOf([&] { OpenDataset(path, options); });
  };
  EXPECT_THAT(message({.camera = camera}),
              HasSubstr("found /back/image (mono8, 1 images), /front/image (mono8, 1 images); "
                        "choose by --topic"));
  EXPECT_THAT(message({.camera = camera, .topics = {"/side/image"}}),
              HasSubstr("expected images on topic '/side/image', found none; topics: /back/image"));
  EXPECT_THAT(message({.camera = camera, .topics = {"/front/image", "/front/image"}}),
              HasSubstr("expected each topic once, found '/front/image' twice"));
  const auto mono = OpenDataset(path, {.camera = camera, .topics = {"/front/image"}});
  EXPECT_EQ(mono->sensor(), SensorKind::kMono);
  EXPECT_EQ(mono->Read(0)->left.at(0, 0), 'a');
  // In this order left and right.
  const auto pair =
      OpenDataset(path, {.camera = camera, .topics = {"/front/image", "/back/image"}});
  ASSERT_EQ(pair->sensor(), SensorKind::kStereo);
  EXPECT_EQ(pair->Read(0)->left.at(0, 0), 'a');
  EXPECT_EQ(pair->Read(0)->right->at(0, 0), 'b');
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.path(), {.topics = {"/a"}}); }),
              HasSubstr("found none of them"));
}

TEST(RecordedErrors, WantACameraFileWhereThereIsNoCameraInfo) {
  const ScratchFolder folder;
  BagWriter bag;
  AddImage(bag, "/cam0/image_raw", Gray(kSecond, 'a'));
  TestCamera uncalibrated;
  uncalibrated.k = {};
  uncalibrated.p = {};
  AddCamera(bag, "/cam0/camera_info", uncalibrated);
  const auto path = Write(folder, bag);
  EXPECT_THAT(
      MessageOf([&] { OpenDataset(path); }),
      HasSubstr("expected a calibration of /cam0/image_raw (sensor_msgs/CameraInfo), found none: "
                "give --camera FILE"));
  EXPECT_FALSE(OpenDataset(path, {.allow_missing_camera = true})->info().has_calibration);
  EXPECT_THAT(MessageOf([&] { OpenDataset(path, {.camera = "euroc"}); }),
              HasSubstr("expected an image of 752x480 pixels as in the calibration, found 8x6"));
}

TEST(RecordedErrors, FailFrameByFrame) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/c/camera_info", {});
  AddImage(bag, "/c/image", Gray(kSecond, 'a'));
  TestImage shorter = Gray(2 * kSecond, 'b');
  shorter.data.resize(40);
  AddImage(bag, "/c/image", shorter);
  const std::string png = Png(8, 6, 'c');
  AddPacked(bag, "/c/image", {3 * kSecond, "png", 0, 0, 0, png.substr(0, png.size() - 4)});
  TestImage bayer = Gray(4 * kSecond, 'd');
  bayer.encoding = "bayer_rggb16";
  AddImage(bag, "/c/image", bayer);
  const auto dataset = OpenDataset(Write(folder, bag));
  ASSERT_EQ(dataset->size(), 4U);
  EXPECT_TRUE(dataset->Read(0));
  EXPECT_EQ(dataset->Read(1).error().why, "/c/image: expected 48 bytes of pixels, found 40");
  EXPECT_EQ(dataset->Read(2).error().why, "/c/image: the file ends early");
  EXPECT_EQ(dataset->Read(3).error().why,
            "/c/image: expected an image, found encoding 'bayer_rggb16'");
}

TEST(RecordedErrors, NameTheTopicOfDepthOfAnotherSize) {
  const ScratchFolder folder;
  BagWriter bag;
  AddCamera(bag, "/rgb/camera_info", {});
  AddImage(bag, "/rgb/image", Gray(kSecond, 'a'));
  AddImage(bag, "/depth/image", {kSecond, "16UC1", 4, 3, 8, std::string(24, '\1')});
  EXPECT_THAT(MessageOf([&] { OpenDataset(Write(folder, bag)); }),
              HasSubstr("x.bag: /depth/image: expected an image of 8x6 pixels as in the "
                        "calibration, found 4x3"));
}

TEST(RecordedErrors, RefuseWhatHasNoImages) {
  const ScratchFolder folder;
  BagWriter bag;
  bag.Add("/imu", "sensor_msgs/Imu", 5, "something");
  EXPECT_THAT(MessageOf([&] { OpenDataset(Write(folder, bag)); }),
              HasSubstr("found sensor_msgs/Imu"));
  BagWriter lying;
  lying.Add("/c/image", "sensor_msgs/Image", 5, "something");
  EXPECT_THAT(
      MessageOf([&] { OpenDataset(Write(folder, lying)); }),
      HasSubstr("expected messages of sensor_msgs/Image on /c/image, found one that is none"));
  EXPECT_THAT(MessageOf([&] { OpenDataset(folder.Write("cut.mcap", "")); }),
              HasSubstr("expected an MCAP file"));
  BagWriter apart;
  AddImage(apart, "/cam0/image_raw", Gray(kSecond, 'a'));
  AddImage(apart, "/cam1/image_raw", Gray(2 * kSecond, 'a'));
  AddCamera(apart, "/cam0/camera_info", {});
  AddCamera(apart, "/cam1/camera_info", RightCamera());
  EXPECT_THAT(MessageOf([&] { OpenDataset(Write(folder, apart)); }),
              HasSubstr("within 5 ms, found none"));
}

}  // namespace
}  // namespace plumbline
