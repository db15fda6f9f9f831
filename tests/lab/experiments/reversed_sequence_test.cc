// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/reversed_sequence.h"

#include "plumbline/base/error.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/trajectory_io.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// The values of the left and right images, of plain ones.
std::vector<int> ValuesOf(const Dataset& dataset, bool right) {
  std::vector<int> values;
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    const auto frame = dataset.Read(i);
    EXPECT_TRUE(frame);
    values.push_back((right ? *frame->right : frame->left).at(0, 0));
  }
  return values;
}

// Expects the frames of the recording in the other order, with their distances in time.
void ExpectReversed(const Dataset& recorded, const Dataset& reversed) {
  ASSERT_EQ(reversed.size(), recorded.size());
  EXPECT_EQ(reversed.sensor(), recorded.sensor());
  const std::int64_t mirror_ns = recorded.stamp_ns(0) + recorded.stamp_ns(recorded.size() - 1);
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    EXPECT_EQ(reversed.stamp_ns(i), mirror_ns - recorded.stamp_ns(recorded.size() - 1 - i));
  }
  for (const bool right : {false, true}) {
    if (right && recorded.sensor() != SensorKind::kStereo) continue;
    std::vector<int> values = ValuesOf(recorded, right);
    std::reverse(values.begin(), values.end());
    EXPECT_EQ(ValuesOf(reversed, right), values);
  }
}

TEST(ReversedSequence, HasTheImagesOfEurocFromTheLastToTheFirst) {
  const ScratchFolder folder, out;
  WriteEuroc(folder);
  WriteReversedSequence(folder.path(), out / "reversed");
  ExpectReversed(*OpenDataset(folder.path()), *OpenDataset(out / "reversed"));
}

TEST(ReversedSequence, HasTheImagesOfKittiFromTheLastToTheFirst) {
  const ScratchFolder folder, out;
  WriteKitti(folder);
  WriteReversedSequence(folder.path(), out / "reversed");
  ExpectReversed(*OpenDataset(folder.path()), *OpenDataset(out / "reversed"));
}

TEST(ReversedSequence, KeepsDepthWithItsImageAndTurnsTheGroundTruthRound) {
  const ScratchFolder folder, out;
  WriteTumFolder(folder);  // colour 1 and 3 have a depth image near in time, of 1 and 2 m
  WriteReversedSequence(folder.path(), out / "reversed");
  const auto recorded = OpenDataset(folder.path()), reversed = OpenDataset(out / "reversed");
  ASSERT_EQ(reversed->sensor(), SensorKind::kRgbd);
  EXPECT_EQ(reversed->Read(0)->left.at(0, 0), 3);
  EXPECT_FLOAT_EQ(reversed->Read(0)->depth->at(0, 0), 2);
  EXPECT_EQ(reversed->Read(1)->left.at(0, 0), 1);
  EXPECT_FLOAT_EQ(reversed->Read(1)->depth->at(0, 0), 1);
  ASSERT_TRUE(recorded->info().ground_truth);
  const Trajectory& poses = recorded->info().ground_truth->poses;
  const Trajectory back = ReadTrajectory(out / "reversed" / kReversedTruth).poses;
  ASSERT_EQ(back.size(), poses.size());
  EXPECT_EQ(back.front().world_from_camera.translation, poses.back().world_from_camera.translation);
  EXPECT_EQ(
      back.front().stamp_ns,
      recorded->stamp_ns(0) + recorded->stamp_ns(recorded->size() - 1) - poses.back().stamp_ns);
}

TEST(ReversedSequence, RefusesDataWithoutAListOfImages) {
  const ScratchFolder folder, out;
  folder.Write("images/1.png", Png(8, 6, 1));
  folder.Write("images/2.png", Png(8, 6, 2));
  EXPECT_THAT(MessageOf([&] { WriteReversedSequence(folder / "images", out / "reversed"); }),
              HasSubstr("expected euroc, kitti or tum to be played backwards, found images"));
  EXPECT_FALSE(std::filesystem::exists(out / "reversed"));
}

}  // namespace
}  // namespace plumbline
