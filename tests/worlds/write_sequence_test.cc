// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/write_sequence.h"

#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Images of a quarter of the camera's width.
SynthOptions Small() {
  SynthOptions options;
  options.frames = 3;
  options.texel = 20;
  options.scale = 0.25;
  return options;
}

SynthOptions Whole() {
  SynthOptions options = Small();
  options.scale = 1;
  return options;
}

std::map<std::string, std::string> AllFiles(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = ReadInputFile(entry.path());
    }
  }
  return files;
}

TEST(SyntheticSequence, BytesDoNotDependOnThreads) {
  const ScratchFolder folder;
  WriteSequence(SyntheticSequence("room", Small(), 1), SequenceFormat::kEuroc, folder / "one", 1);
  int last = 0;
  WriteSequence(SyntheticSequence("room", Small(), 2),
                SequenceFormat::kEuroc,
                folder / "two",
                2,
                [&](int done) { EXPECT_EQ(done, ++last); });
  EXPECT_EQ(last, 3);
  const auto one = AllFiles(folder / "one"), two = AllFiles(folder / "two");
  // 6 images, 2 x (data.csv, sensor.yaml), imu0 (3), ground truth, lines, surfaces, world
  EXPECT_EQ(one.size(), 17U);
  ASSERT_EQ(one.size(), two.size());
  for (const auto& [name, bytes] : one) {
    ASSERT_TRUE(two.contains(name)) << name;
    EXPECT_TRUE(two.at(name) == bytes) << name;
  }
}

// Sums of pixels that were rendered elsewhere: a processor with other vector instructions must
// not round in another way.
TEST(SyntheticSequence, ImagesAreTheSameOnEveryProcessor) {
  const auto checksum = [](const char* world) {
    const GrayImage image = SyntheticSequence(world, Whole(), 1).RenderImage(0, 0);
    return Crc32({image.data(), static_cast<std::size_t>(image.width() * image.height())});
  };
  EXPECT_EQ(checksum("room"), 2069890217U);
  EXPECT_EQ(checksum("lowtexture"), 3819369379U);
}

TEST(SyntheticSequence, SeedsMakeDifferentImages) {
  SynthOptions options = Small();
  const GrayImage a = SyntheticSequence("room", options, 1).RenderImage(0, 0);
  options.seed = 2;
  const GrayImage b = SyntheticSequence("room", options, 1).RenderImage(0, 0);
  int different = 0;
  for (int i = 0; i < a.width() * a.height(); ++i) different += a.data()[i] != b.data()[i] ? 1 : 0;
  EXPECT_GT(different, a.width() * a.height() / 2);
}

TEST(SyntheticSequence, OpensAsEurocWithTheSameGeometry) {
  for (const bool distortion : {true, false}) {
    const ScratchFolder folder;
    SynthOptions options = Small();
    options.frames = 2;
    options.distortion = distortion;
    const SyntheticSequence sequence("planar", options, 1);
    WriteSequence(sequence, SequenceFormat::kEuroc, folder / "room", 1);
    const auto dataset = OpenDataset(folder / "room");
    EXPECT_EQ(dataset->sensor(), SensorKind::kStereo);
    ASSERT_EQ(dataset->size(), 2U);
    EXPECT_EQ(dataset->stamp_ns(1), sequence.StampNs(1));

    const Calibration& read = dataset->calibration();
    const Calibration& made = sequence.calibration();
    EXPECT_LT(LogSe3(Inverse(read.right_from_left) * made.right_from_left).norm(), 1e-9);
    ASSERT_TRUE(read.right && read.body_from_left && read.rate_hz);
    EXPECT_LT(LogSe3(Inverse(*read.body_from_left) * *made.body_from_left).norm(), 1e-9);
    EXPECT_NEAR(*read.rate_hz, 20, 1e-9);
    const Eigen::Vector3d point(0.7, -0.4, 1.5);
    EXPECT_LT((*read.left.Project(point) - *made.left.Project(point)).norm(), 1e-9);
    EXPECT_LT((*read.right->Project(point) - *made.right->Project(point)).norm(), 1e-9);

    ASSERT_TRUE(dataset->info().ground_truth);
    const Trajectory poses = dataset->info().ground_truth->OfCamera(read);
    EXPECT_EQ(poses.size(), 11U);  // 200 Hz between frames of 20 Hz
    for (const StampedPose& frame : sequence.GroundTruth()) {
      const auto found = InterpolateAt(poses, frame.stamp_ns, 0);
      ASSERT_TRUE(found);
      EXPECT_LT(LogSe3(Inverse(*found) * frame.world_from_camera).norm(), 1e-9);
    }

    const auto pair = dataset->Read(1);
    ASSERT_TRUE(static_cast<bool>(pair));
    ASSERT_TRUE(pair->right);
    const GrayImage image = sequence.RenderImage(1, 1);
    EXPECT_TRUE(std::equal(
        image.data(), image.data() + image.width() * image.height(), pair->right->data()));
  }
}

TEST(WriteSequence, TumFolderHasDepthAndTheSamePoses) {
  const ScratchFolder folder;
  SynthOptions options = Small();
  options.depth_noise = 0;
  const SyntheticSequence sequence("room", options, 1);
  WriteSequence(sequence, SequenceFormat::kTum, folder / "room", 1);
  const auto dataset = OpenDataset(folder / "room");
  EXPECT_EQ(dataset->sensor(), SensorKind::kRgbd);
  ASSERT_EQ(dataset->size(), 3U);
  const Calibration& read = dataset->calibration();
  const Eigen::Vector3d point(0.7, -0.4, 1.5);
  EXPECT_LT((*read.left.Project(point) - *sequence.calibration().left.Project(point)).norm(), 1e-9);
  const Trajectory poses = dataset->info().ground_truth->OfCamera(read);
  for (const StampedPose& frame : sequence.GroundTruth()) {
    const auto found = InterpolateAt(poses, frame.stamp_ns, 0);
    ASSERT_TRUE(found);
    EXPECT_LT(LogSe3(Inverse(*found) * frame.world_from_camera).norm(), 1e-8);
  }
  const auto frame = dataset->Read(1);
  ASSERT_TRUE(static_cast<bool>(frame));
  ASSERT_TRUE(frame->depth);
  const Rendering ideal = sequence.RenderIdeal(1, 0);
  for (int i = 0; i < ideal.depth.width() * ideal.depth.height(); ++i) {
    ASSERT_NEAR(
        frame->depth->data()[i], ideal.depth.data()[i], 1.01e-4);  // half a step of 1/5000 m
  }
}

TEST(WriteSequence, EurocFolderHasDepthWhereAskedFor) {
  const ScratchFolder folder;
  SynthOptions options = Small();
  options.frames = 1;
  options.depth = true;
  WriteSequence(
      SyntheticSequence("planar", options, 1), SequenceFormat::kEuroc, folder / "room", 1);
  EXPECT_TRUE(fs::exists(folder / "room" / "mav0" / "depth0" / "data" / "1500000000000000000.png"));
  EXPECT_TRUE(fs::exists(folder / "room" / "mav0" / "depth0" / "data.csv"));
}

TEST(WriteSequence, WorldYamlSaysHowItWasMade) {
  const ScratchFolder folder;
  SynthOptions options = Small();
  options.frames = 1;
  WriteSequence(
      SyntheticSequence("planar", options, 1), SequenceFormat::kEuroc, folder / "room", 1);
  const std::string world = ReadInputFile(folder / "room" / "world.yaml");
  EXPECT_THAT(world, testing::HasSubstr("world: planar\nformat: euroc\n"));
  EXPECT_THAT(world, testing::HasSubstr("\nframes: 1"));
  EXPECT_FALSE(fs::exists(folder / "room" / "world.yaml.part"));
}

TEST(WriteSequence, ABrokenCallLeavesNothingThatLooksWhole) {
  const ScratchFolder folder;
  const SyntheticSequence sequence("planar", Small(), 1);
  const auto broken = [](int done) {
    if (done == 2) throw InputError("killed");
  };
  WriteSequence(sequence, SequenceFormat::kEuroc, folder / "room", 1);
  EXPECT_THROW(WriteSequence(sequence, SequenceFormat::kEuroc, folder / "room", 1, broken),
               InputError);
  EXPECT_FALSE(fs::exists(folder / "room" / "world.yaml"));
  EXPECT_THROW(OpenDataset(folder / "room"), InputError);
  // The next call clears what is there, also of the other format.
  WriteSequence(sequence, SequenceFormat::kTum, folder / "room", 1);
  EXPECT_TRUE(fs::exists(folder / "room" / "world.yaml"));
  EXPECT_FALSE(fs::exists(folder / "room" / "mav0"));
  EXPECT_EQ(OpenDataset(folder / "room")->sensor(), SensorKind::kRgbd);
}

TEST(WriteSequence, TouchesNoFolderOfOthers) {
  const ScratchFolder folder;
  MakeFolder(folder / "mine");
  WriteFileAtomically(folder / "mine" / "diary.txt", "dear");
  const SyntheticSequence sequence("planar", Small(), 1);
  for (const char* name : {"mine", "mine/diary.txt"}) {
    EXPECT_THROW(WriteSequence(sequence, SequenceFormat::kEuroc, folder / name, 1), InputError);
  }
  EXPECT_EQ(ReadInputFile(folder / "mine" / "diary.txt"), "dear");
}

TEST(WriteSequence, AWorldOfAUserIsNoRenderedSequence) {
  const ScratchFolder folder;
  const SyntheticSequence sequence("planar", Small(), 1);
  for (const char* name : {"world.yaml", "world.yaml.part"}) {
    fs::remove_all(folder / "mine");
    folder.Write(std::string("mine/") + name, "lamps: []\n");
    folder.Write("mine/rgb/a.png", "mine");
    EXPECT_THAT(
        MessageOf([&] { WriteSequence(sequence, SequenceFormat::kEuroc, folder / "mine", 1); }),
        testing::HasSubstr("expected an empty folder or one with a rendered sequence"));
    EXPECT_EQ(ReadInputFile(folder / "mine" / name), "lamps: []\n");
    EXPECT_EQ(ReadInputFile(folder / "mine/rgb/a.png"), "mine");
  }
}

TEST(WriteSequence, AFileThatAUserPutIntoASequenceIsNotRemoved) {
  const ScratchFolder folder;
  SynthOptions options = Small();
  options.frames = 1;
  options.depth = true;
  const SyntheticSequence sequence("planar", options, 1);
  for (const SequenceFormat format : {SequenceFormat::kEuroc, SequenceFormat::kTum}) {
    const bool euroc = format == SequenceFormat::kEuroc;
    const fs::path room = folder / NameOf(format);
    WriteSequence(sequence, format, room, 1);
    const std::string images = euroc ? "mav0/cam0/data/" : "rgb/";
    for (const std::string& name : {images + "notes.txt", images + "mine/1.png"}) {
      const fs::path mine = folder.Write(std::string(NameOf(format)) + "/" + name, "mine");
      EXPECT_THAT(MessageOf([&] { WriteSequence(sequence, format, room, 1); }),
                  testing::StartsWith(mine.string() + ": not of a rendered sequence"));
      EXPECT_EQ(ReadInputFile(mine), "mine");
      EXPECT_TRUE(fs::exists(room / "world.yaml"));
      EXPECT_TRUE(OpenDataset(room)->Read(0));
      fs::remove(mine);
    }
    // Beside the sequence it is in nobody's way; what a call that was killed left is ours.
    folder.Write(std::string(NameOf(format)) + "/notes.txt", "mine");
    folder.Write(std::string(NameOf(format)) + "/" + images + ".1.png.123.tmp.png", "half");
    WriteSequence(sequence, format, room, 1);
    EXPECT_EQ(ReadInputFile(room / "notes.txt"), "mine");
    EXPECT_FALSE(fs::exists(room / images / ".1.png.123.tmp.png"));
  }
}

TEST(WriteSequence, WhatACallLeftThatEndedAtOnceIsReplaced) {
  const ScratchFolder folder;
  PrepareSequenceFolder(folder / "room");
  PrepareSequenceFolder(folder / "room");
  EXPECT_TRUE(fs::exists(folder / "room/world.yaml.part"));
}

// The next one may turn out to be impossible.
TEST(WriteSequence, AFolderIsCheckedWithoutLossOfTheSequenceInIt) {
  const ScratchFolder folder;
  CheckSequenceFolder(folder / "room");
  EXPECT_TRUE(fs::is_empty(folder / "room"));
  SynthOptions options = Small();
  options.frames = 1;
  WriteSequence(SyntheticSequence("room", options, 1), SequenceFormat::kTum, folder / "room", 1);
  const auto before = AllFiles(folder / "room");
  CheckSequenceFolder(folder / "room");
  EXPECT_EQ(AllFiles(folder / "room"), before);
  folder.Write("diary/diary.txt", "dear");
  EXPECT_THAT(MessageOf([&] { CheckSequenceFolder(folder / "diary"); }),
              testing::HasSubstr("diary: expected an empty folder or one with a rendered"));
  EXPECT_EQ(AllFiles(folder / "diary").size(), 1U);
}

TEST(SyntheticSequence, RefusesWhatCannotBe) {
  EXPECT_THROW(SyntheticSequence("atlantis", Small(), 1), InputError);
  SynthOptions options = Small();
  options.shutter_ms = 40;
  options.readout_ms = 20;
  EXPECT_THROW(SyntheticSequence("room", options, 1), InputError);
  options = Small();
  options.camera = SynthCamera::kKitti;
  options.distortion = true;
  EXPECT_THROW(SyntheticSequence("room", options, 1), InputError);
}

TEST(SyntheticSequence, ScaleMakesTheSameImageSmaller) {
  SynthOptions options = Whole();
  options.noise = 0;
  options.vignetting = 0;
  options.samples = 16;
  options.scale = 0.5;
  options.texel = 1;
  const Image<float> whole = SyntheticSequence("room", options, 2).RenderIdeal(1, 0).light;
  options.scale = 0.25;
  options.texel = 0.5;  // of a pixel twice as large
  const Image<float> half = SyntheticSequence("room", options, 2).RenderIdeal(1, 0).light;
  ASSERT_EQ(half.width(), 188);
  ASSERT_EQ(half.height(), 120);
  double difference = 0, contrast = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 188; ++x) {
      const float mean = 0.25F * (whole.at(2 * x, 2 * y) + whole.at(2 * x + 1, 2 * y) +
                                  whole.at(2 * x, 2 * y + 1) + whole.at(2 * x + 1, 2 * y + 1));
      difference += static_cast<double>(std::abs(half.at(x, y) - mean));
      if (x > 0) contrast += static_cast<double>(std::abs(half.at(x, y) - half.at(x - 1, y)));
    }
  }
  EXPECT_LT(difference, 0.5 * contrast);
}

// The level of an image of light where a camera sees a direction.
float LightAt(const Image<float>& light, const Camera& camera, const Eigen::Vector3d& ray) {
  const Eigen::Vector2d px = camera.Project(ray).value();
  return light.at(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y())));
}

// Every lens shows the same world in the same directions.
TEST(SyntheticSequence, EveryLensSeesWhatAPinholeSees) {
  SynthOptions options = Small();
  options.noise = 0;
  options.samples = 8;
  options.texel = 4;
  options.lens = SynthLens::kPinhole;
  options.view_deg = 100;
  const SyntheticSequence pinhole("room", options, 2);
  const Image<float> expected = pinhole.RenderIdeal(1, 0).light;
  for (const auto& [lens, name] : EnumNames(std::type_identity<SynthLens>{})) {
    if (lens == SynthLens::kEuroc || lens == SynthLens::kPinhole) continue;
    options.lens = lens;
    const SyntheticSequence sequence("room", options, 2);
    const Camera& camera = sequence.calibration().left;
    const double half = 50 * M_PI / 180;
    EXPECT_NEAR(camera.Project({std::sin(half), 0, std::cos(half)})->x() - camera.intrinsics().cx,
                0.5 * camera.width(),
                1e-6)
        << name;
    const Image<float> light = sequence.RenderIdeal(1, 0).light;
    double difference = 0, contrast = 0;
    float last = 0;
    for (double y = -0.4; y < 0.4; y += 0.02) {
      for (double x = -0.7; x < 0.7; x += 0.02) {
        const float found = LightAt(light, camera, {x, y, 1});
        const float wanted = LightAt(expected, pinhole.calibration().left, {x, y, 1});
        difference += static_cast<double>(std::abs(found - wanted));
        contrast += static_cast<double>(std::abs(wanted - last));
        last = wanted;
      }
    }
    EXPECT_LT(difference, 0.6 * contrast) << name;
  }
}

TEST(WriteSequence, AnyLensIsReadAsItWasRendered) {
  for (const auto& [format, lens] : {std::pair{SequenceFormat::kEuroc, SynthLens::kOmni},
                                     {SequenceFormat::kEuroc, SynthLens::kEuroc},
                                     {SequenceFormat::kTum, SynthLens::kRational}}) {
    SynthOptions options = Small();
    options.frames = 2;
    if (lens == SynthLens::kEuroc) options.camera = SynthCamera::kTumVi;
    options.lens = lens;
    options.view_deg = 90;
    const ScratchFolder folder;
    const SyntheticSequence sequence("room", options, 1);
    WriteSequence(sequence, format, folder / "s", 1);
    const auto dataset = OpenDataset(folder / "s");
    const CameraIntrinsics& read = dataset->calibration().left.intrinsics();
    const CameraIntrinsics& rendered = sequence.calibration().left.intrinsics();
    EXPECT_EQ(read.model, rendered.model);
    EXPECT_NEAR(read.fx, rendered.fx, 1e-9);
    EXPECT_NEAR(read.distortion[1], rendered.distortion[1], 1e-12);
    EXPECT_TRUE(dataset->info().ground_truth);
  }
}

// Masks of the sequence before would leave out parts of the images of this one.
TEST(WriteSequence, MasksGoWithTheSequenceTheyWereRenderedFor) {
  SynthOptions options = Small();
  options.frames = 1;
  for (const SequenceFormat format : {SequenceFormat::kEuroc, SequenceFormat::kTum}) {
    const ScratchFolder folder;
    options.text = options.person = true;
    WriteSequence(SyntheticSequence("planar", options, 1), format, folder / "room", 1);
    EXPECT_TRUE(OpenDataset(folder / "room")->Read(0)->left_mask);
    options.text = options.person = false;
    const SyntheticSequence plain("planar", options, 1);
    WriteSequence(plain, format, folder / "room", 1);
    WriteSequence(plain, format, folder / "plain", 1);
    EXPECT_EQ(AllFiles(folder / "room"), AllFiles(folder / "plain"));
    EXPECT_FALSE(fs::exists(folder / "room/mask0"));
  }
}

TEST(WriteSequence, MasksOfAnotherProgramAreNotRemoved) {
  SynthOptions options = Small();
  options.frames = 1;
  const ScratchFolder folder;
  const SyntheticSequence plain("planar", options, 1);
  WriteSequence(plain, SequenceFormat::kEuroc, folder / "room", 1);
  for (const char* name : {"mask0/1500000000000000000.png", "mask1", "mask_text.png"}) {
    const fs::path mine = folder.Write(std::string("room/") + name, "mine");
    EXPECT_THAT(
        MessageOf([&] { WriteSequence(plain, SequenceFormat::kEuroc, folder / "room", 1); }),
        testing::StartsWith(mine.string() + ": not of a rendered sequence"));
    EXPECT_EQ(ReadInputFile(mine), "mine");
    fs::remove_all(folder / "room/mask0");
    fs::remove(mine);
  }
}

TEST(WriteSequence, TextAndAPersonHaveMasks) {
  SynthOptions options = Small();
  options.rate_hz = 1;
  options.frames = 8;
  options.lens = SynthLens::kPinhole;
  const ScratchFolder folder;
  WriteSequence(SyntheticSequence("room", options, 1), SequenceFormat::kEuroc, folder / "none", 1);
  options.text = options.person = true;
  WriteSequence(SyntheticSequence("room", options, 1), SequenceFormat::kEuroc, folder / "both", 1);
  const auto none = OpenDataset(folder / "none");
  const auto both =
      OpenDataset(folder / "both", {.masks = {(folder / "both/mask_text.png").string()}});
  std::vector<int> masked;
  for (std::size_t i = 0; i < both->size(); ++i) {
    const SensorFrame plain = *none->Read(i), drawn = *both->Read(i);
    ASSERT_TRUE(drawn.left_mask);
    int different = 0, black = 0;
    for (int y = 0; y < plain.left.height(); ++y) {
      for (int x = 0; x < plain.left.width(); ++x) {
        const bool used = drawn.left_mask->at(x, y) != 0;
        black += used ? 0 : 1;
        if (plain.left.at(x, y) == drawn.left.at(x, y)) continue;
        ++different;
        EXPECT_FALSE(used) << x << " " << y;
      }
    }
    EXPECT_GT(different, black / 2);
    masked.push_back(black);
  }
  // The text alone, or somebody as well.
  const int text = *std::min_element(masked.begin(), masked.end());
  EXPECT_GT(text, 500);
  EXPECT_EQ(std::count_if(masked.begin(), masked.end(), [&](int b) { return b > text + 50; }), 4);
}

TEST(SyntheticSequence, KittisCamerasAreIdealAndScale) {
  SynthOptions options = Small();
  options.camera = SynthCamera::kKitti;
  options.distortion = false;
  options.scale = 0.5;
  options.baseline = 0.537;
  const Calibration calibration = SyntheticSequence("planar", options, 2).calibration();
  const CameraIntrinsics& left = calibration.left.intrinsics();
  EXPECT_EQ(left.width, 621);
  EXPECT_EQ(left.height, 188);
  EXPECT_NEAR(left.fx, 359.428, 1e-9);
  EXPECT_NEAR(left.cx, 0.5 * (607.1928 + 0.5) - 0.5, 1e-9);
  EXPECT_EQ(calibration.right->intrinsics().cx, left.cx);
  EXPECT_TRUE(calibration.rectified);
  EXPECT_NEAR(calibration.right_from_left.translation.x(), -0.537, 1e-12);
}

TEST(SyntheticSequence, AutoExposureFollowsTheScene) {
  SynthOptions options = Small();
  options.auto_exposure = true;
  options.noise = 0;
  const auto mean = [&](double speed, int frame) {
    options.speed = speed;
    const SyntheticSequence sequence("room", options, 2);
    const GrayImage image = sequence.RenderImage(frame, 0);
    double sum = 0;
    for (int i = 0; i < image.width() * image.height(); ++i) sum += image.data()[i];
    return sum / (image.width() * image.height());
  };
  // The mean is the control's aim times the exposure asked for, at the start exactly.
  options.exposure = 1;
  EXPECT_NEAR(mean(1, 0), 85 * (1 - options.vignetting / 3), 8);
}

TEST(SyntheticSequence, UnknownWorldsAreNamed) {
  try {
    const SyntheticSequence sequence("moon", Small(), 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex("world: expected one of room.*, found moon"));
  }
}

}  // namespace
}  // namespace plumbline
