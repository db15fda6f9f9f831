// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/keyframe_images.h"

#include "plumbline/features/extractor.h"
#include "plumbline/image/filters.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/export/png.h"

#include "tests/e2e/poster_sequence.h"
#include "tests/io/scratch_folder.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// A map with keyframes at these times, made with a camera of the poster sequence.
SavedMap MapAt(const std::vector<std::int64_t>& stamps_ns, const Calibration& calibration) {
  const Rectifier rectifier(calibration);
  SavedMap saved;
  saved.camera = rectifier.camera();
  saved.rectified_from_left = rectifier.rectified_left_from_left();
  std::int64_t id = 0;
  for (const std::int64_t stamp : stamps_ns) {
    KeyFrame keyframe{KeyFrameId{id}, KeyFrameId{id - 1}, {}};
    keyframe.frame.stamp_ns = stamp;
    keyframe.frame.indexed = std::make_shared<FrameFeatures>();
    saved.map.Apply({edit::AddKeyFrame{keyframe}});
    ++id;
  }
  return saved;
}

TEST(KeyFrameImageNames, AreTimesAndDifferEach) {
  const SavedMap saved =
      MapAt({1'403'636'580'863'555'584, 7, 8, 7, 7}, MovingPoster::MakeCalibration());
  std::vector<std::string> names;
  for (const auto& [id, name] : KeyFrameImageNames(saved.map)) names.push_back(name);
  EXPECT_EQ(names,
            (std::vector<std::string>{
                "1403636580863555584.png", "7.png", "8.png", "7_2.png", "7_3.png"}));
}

TEST(KeyFrameImages, AreThoseOfTheirTimes) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 12);
  const SavedMap saved =
      MapAt({MovingPoster::StampNs(2), MovingPoster::StampNs(9)}, MovingPoster::MakeCalibration());
  const KeyFrameImages images(sequence, {}, saved);
  const MovingPoster poster;
  for (const auto& [id, frame] : {std::pair{0, 2}, std::pair{1, 9}}) {
    const ColorImage read = images.Read(*saved.map.Find(KeyFrameId{id}));
    EXPECT_TRUE(IsGray(read));
    const GrayImage& image = read.red;
    const GrayImage expected = poster.Frame(frame).left;
    ASSERT_EQ(image.width(), expected.width());
    EXPECT_TRUE(
        std::equal(image.data(), image.data() + image.width() * image.height(), expected.data()));
  }
}

// A map of one camera is not of the rectified pair: where that differs, the data are looked at as
// the sensor that fits.
TEST(KeyFrameImages, FindTheSensorThatTheMapWasMadeWith) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 3);
  std::string turned = PosterSensor(MovingPoster::kBaseline);
  turned.replace(turned.find("0,0,1,0,"), 8, "0,0,1,0.02,");  // the pair is to be rectified
  folder.Write("sequence/mav0/cam1/sensor.yaml", turned);
  Calibration single = MovingPoster::MakeCalibration();
  single.right.reset();
  single.rectified = false;
  const SavedMap mono = MapAt({MovingPoster::StampNs(1)}, single);
  const KeyFrameImages images(sequence, {}, mono);
  EXPECT_EQ(images.Read(*mono.map.Find(KeyFrameId{0})).red.at(30, 40),
            MovingPoster().Frame(1).left.at(30, 40));
  EXPECT_THAT(MessageOf([&] { KeyFrameImages(sequence, {.sensor = SensorKind::kStereo}, mono); }),
              HasSubstr("sequence: expected the camera that the map was made with, found another "
                        "one: "));
}

// The view angle of the run is found out for any lens and reduction, or named.
TEST(KeyFrameImages, AreCutOutAsTheRunDid) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 3);
  for (const SensorKind sensor : {SensorKind::kMono, SensorKind::kStereo}) {
    for (const std::optional<int> width : {std::optional<int>(), std::optional<int>(300)}) {
      const DatasetOptions of_run{.sensor = sensor, .max_width = width, .view_angle_deg = 50};
      const auto dataset = OpenDataset(sequence, of_run);
      const SavedMap saved = MapAt({MovingPoster::StampNs(1)}, dataset->calibration());
      const KeyFrameImages images(sequence, {}, saved);
      const KeyFrame& keyframe = *saved.map.Find(KeyFrameId{0});
      EXPECT_EQ(images.Read(keyframe).width(), saved.camera.width);
      EXPECT_EQ(images.Read(keyframe, ImageForm::kDelivered).width(), width.value_or(400));
      EXPECT_EQ(images.DeliveredCamera().intrinsics().width, width.value_or(400));
    }
  }
  const auto dataset = OpenDataset(sequence, {.view_angle_deg = 50});
  const SavedMap saved = MapAt({MovingPoster::StampNs(1)}, dataset->calibration());
  EXPECT_THAT(MessageOf([&] { KeyFrameImages(sequence, {.view_angle_deg = 40}, saved); }),
              HasSubstr("found another one: view angles of 50 and 40 degrees"));
  const SavedMap whole = MapAt({MovingPoster::StampNs(1)}, MovingPoster::MakeCalibration());
  EXPECT_THAT(MessageOf([&] { KeyFrameImages(sequence, {.view_angle_deg = 40}, whole); }),
              HasSubstr("cut out as by default and with a view angle of 40 degrees"));
}

TEST(KeyFrameImages, NamesWhatDoesNotFit) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 3);
  SavedMap saved = MapAt({MovingPoster::StampNs(1), 7}, MovingPoster::MakeCalibration());
  EXPECT_THAT(
      MessageOf([&] { KeyFrameImages(sequence, {}, saved); }),
      HasSubstr(
          "sequence: expected a frame at 0.000000007 s, where the map has keyframe 1, found"));
  saved.camera.fx = 310;
  EXPECT_THAT(MessageOf([&] { KeyFrameImages(sequence, {}, saved); }),
              HasSubstr("found another one: fx 310 and 300"));
  EXPECT_THAT(MessageOf([&] { KeyFrameImages(folder / "none", {}, saved); }),
              HasSubstr("none: no such file or folder"));
  const SavedMap whole = MapAt({MovingPoster::StampNs(1)}, MovingPoster::MakeCalibration());
  const KeyFrameImages images(sequence, {}, whole);
  folder.Write("sequence/mav0/cam0/data/1.png", "text");
  EXPECT_THAT(MessageOf([&] { images.Read(*whole.map.Find(KeyFrameId{0})); }),
              HasSubstr("cam0/data/1.png: not an image"));
}

// A map whose keyframe at a time of the poster sequence was made of this image.
SavedMap MapOfImage(int frame, const GrayImage& image, const FeatureOptions& options = {}) {
  SavedMap saved = MapAt({}, MovingPoster::MakeCalibration());
  KeyFrame keyframe{KeyFrameId{0}, KeyFrameId{-1}, {}};
  keyframe.frame.stamp_ns = MovingPoster::StampNs(frame);
  keyframe.frame.indexed =
      IndexFeatures(saved.camera, ExtractFeatures(saved.camera, {.left = &image}, options));
  keyframe.frame.points.resize(keyframe.frame.features().points.size());
  keyframe.frame.lines.resize(keyframe.frame.features().lines.size());
  saved.map.Apply({edit::AddKeyFrame{keyframe}});
  saved.octave_scale = options.orb.scale_factor;
  return saved;
}

// Frames of a data set in colour are compared by their grey levels, and come out in colour.
TEST(KeyFrameImages, AreInColourWhereTheDataAre) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 12);
  const MovingPoster poster;
  const auto colored = [&](int frame) {
    ColorImage image = ToColor(poster.Frame(frame).left);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        image.blue.at(x, y) = static_cast<std::uint8_t>(255 - image.blue.at(x, y));
      }
    }
    return image;
  };
  for (const int frame : {2, 5}) {
    WriteColorPng(sequence / fmt::format("mav0/cam0/data/{}.png", frame), colored(frame));
  }
  const SavedMap saved = MapOfImage(2, ToGray(colored(2)));
  const auto open = [&] { return OpenDataset(sequence, {.sensor = SensorKind::kStereo}); };
  for (const KeyFrameImages& images :
       {KeyFrameImages(sequence, {}, saved), KeyFrameImages(open(), saved)}) {
    const ColorImage image = images.Read(*saved.map.Find(KeyFrameId{0}));
    EXPECT_TRUE(image.at(30, 40) == colored(2).at(30, 40));
    EXPECT_FALSE(IsGray(image));
    EXPECT_TRUE(images.HasFrame(MovingPoster::StampNs(5)));
    EXPECT_FALSE(images.HasFrame(MovingPoster::StampNs(5) + 1));
    EXPECT_TRUE(images.ReadAt(MovingPoster::StampNs(5)).at(30, 40) == colored(5).at(30, 40));
  }
  const SavedMap other = MapOfImage(2, poster.Frame(9).left);
  EXPECT_THAT(
      MessageOf([&] { KeyFrameImages(open(), other).Read(*other.map.Find(KeyFrameId{0})); }),
      HasSubstr("expected the images that the map was made of"));
}

// Frames of the same times that are others: of another
// session of the map.
TEST(KeyFrameImages, RefuseImagesThatAreNotThoseOfTheKeyframes) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 12);
  const MovingPoster poster;
  for (const auto& [points, lines] : {std::pair{true, true}, {true, false}, {false, true}}) {
    FeatureOptions options;
    options.points = points;
    options.lines = lines;
    const auto message = [&](int frame, const GrayImage& image) {
      const SavedMap saved = MapOfImage(frame, image, options);
      const KeyFrameImages images(sequence, {}, saved);
      return MessageOf([&] { images.Read(*saved.map.Find(KeyFrameId{0})); });
    };
    EXPECT_EQ(message(2, poster.Frame(2).left), "no error") << points << lines;
    EXPECT_EQ(message(2, BoxFiltered(poster.Frame(2).left, 5)), "no error") << points << lines;
    EXPECT_THAT(message(2, poster.Frame(9).left),
                HasSubstr("sequence: expected the images that the map was made of, found another "
                          "one at 1.100000000 s, where the map has keyframe 0 "
                          "(another session?)"))
        << points << lines;
  }
}

// What cannot be compared is taken as it is: too few features, and a map of a file that does not
// say how they were described.
TEST(KeyFrameImages, TakeWhatTheyCannotCompare) {
  const ScratchFolder folder;
  const std::filesystem::path sequence = WritePosterSequence(folder, 12);
  const GrayImage other = MovingPoster().Frame(9).left;
  FeatureOptions options;
  options.point_count = 20;
  options.lines = false;
  const SavedMap few = MapOfImage(2, other, options);
  EXPECT_NO_THROW(KeyFrameImages(sequence, {}, few).Read(*few.map.Find(KeyFrameId{0})));
  SavedMap unknown = MapOfImage(2, other);
  unknown.octave_scale.reset();
  EXPECT_NO_THROW(KeyFrameImages(sequence, {}, unknown).Read(*unknown.map.Find(KeyFrameId{0})));
}

}  // namespace
}  // namespace plumbline
