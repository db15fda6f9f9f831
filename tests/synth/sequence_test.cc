// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/sequence.h"

#include "plumbline/base/error.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/text_rows.h"

#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

SynthOptions Small() {
  SynthOptions options;
  options.frames = 3;
  options.texel = 0.05;
  return options;
}

std::map<std::string, std::string> AllFiles(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = ReadTextFile(entry.path());
    }
  }
  return files;
}

TEST(StereoSequence, BytesDoNotDependOnThreads) {
  const ScratchFolder folder;
  WriteSequence(StereoSequence("room", Small(), 1), folder / "one", 1);
  int last = 0;
  WriteSequence(StereoSequence("room", Small(), 2), folder / "two", 2, [&](int done) {
    EXPECT_EQ(done, ++last);
  });
  EXPECT_EQ(last, 3);
  const auto one = AllFiles(folder / "one"), two = AllFiles(folder / "two");
  EXPECT_EQ(one.size(), 13U);  // 6 images, 2 x (data.csv, sensor.yaml), ground truth, lines, world
  ASSERT_EQ(one.size(), two.size());
  for (const auto& [name, bytes] : one) {
    ASSERT_TRUE(two.contains(name)) << name;
    EXPECT_TRUE(two.at(name) == bytes) << name;
  }
}

TEST(StereoSequence, SeedsMakeDifferentImages) {
  SynthOptions options = Small();
  const GrayImage a = StereoSequence("room", options, 1).RenderImage(0, 0);
  options.seed = 2;
  const GrayImage b = StereoSequence("room", options, 1).RenderImage(0, 0);
  int different = 0;
  for (int i = 0; i < a.width() * a.height(); ++i) different += a.data()[i] != b.data()[i] ? 1 : 0;
  EXPECT_GT(different, a.width() * a.height() / 2);
}

TEST(StereoSequence, OpensAsEurocWithTheSameGeometry) {
  for (const bool distortion : {true, false}) {
    const ScratchFolder folder;
    SynthOptions options = Small();
    options.frames = 2;
    options.distortion = distortion;
    const StereoSequence sequence("room", options, 1);
    WriteSequence(sequence, folder / "room", 1);
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

TEST(StereoSequence, WritesItsEdgesAndOptions) {
  const ScratchFolder folder;
  SynthOptions options = Small();
  options.frames = 1;
  const StereoSequence sequence("room", options, 1);
  WriteSequence(sequence, folder / "room", 1);
  const std::vector<TextRow> rows = ReadRows(folder / "room" / "lines.csv", ',');
  const std::vector<Segment3>& edges = sequence.scene().edges;
  ASSERT_EQ(rows.size(), edges.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].fields.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
      const double expected =
          k < 3 ? edges[i].start(static_cast<int>(k)) : edges[i].end(static_cast<int>(k) - 3);
      ASSERT_NEAR(*ParseNumber(rows[i].fields[k]), expected, 1e-8);
    }
  }
  const std::string world = ReadTextFile(folder / "room" / "world.yaml");
  EXPECT_THAT(world, testing::HasSubstr("world: room\n"));
  EXPECT_THAT(world, testing::HasSubstr("\nframes: 1"));
}

TEST(StereoSequence, NoiseHasTheSizeAskedFor) {
  SynthOptions options = Small();
  options.frames = 1;
  options.noise = 0;
  const GrayImage clean = StereoSequence("room", options, 1).RenderImage(0, 0);
  options.noise = 2;
  const GrayImage noisy = StereoSequence("room", options, 1).RenderImage(0, 0);
  double squares = 0, variance = 0;
  int count = 0;
  for (int i = 0; i < clean.width() * clean.height(); ++i) {
    const double value = clean.data()[i];
    if (value < 30 || value > 220) continue;  // free of clipping
    squares += std::pow(noisy.data()[i] - value, 2);
    variance += 4 * (1.5 + 0.02 * value) + 1.0 / 6;  // and the rounding of both
    ++count;
  }
  ASSERT_GT(count, 100'000);
  EXPECT_NEAR(squares / variance, 1, 0.02);
}

TEST(StereoSequence, UnknownWorldsAreNamed) {
  try {
    const StereoSequence sequence("moon", Small(), 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "world: expected one of room, found moon");
  }
}

}  // namespace
}  // namespace plumbline
