// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/reversed_dataset.h"

#include "plumbline/base/error.h"
#include "plumbline/io/open_dataset.h"
#include "plumbline/io/png.h"

#include "tests/io/dataset_fixtures.h"
#include "tests/io/scratch_folder.h"
#include <algorithm>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;

TEST(PlayedBackwards, GivesStereoPairsFromTheLastToTheFirst) {
  const ScratchFolder folder;
  WriteEuroc(folder);  // at 100, 200, 300 ns, values 1, 2, 3 and 11, 12, 13
  const auto played = PlayedBackwards(OpenDataset(folder.path()), {0, 1, 2});
  EXPECT_EQ(played->sensor(), SensorKind::kStereo);
  ASSERT_THAT(played->info().stamps_ns, ElementsAre(100, 200, 300));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto frame = played->Read(i);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stamp_ns, played->stamp_ns(i));
    EXPECT_EQ(frame->left.at(0, 0), 3 - static_cast<int>(i));
    EXPECT_EQ(frame->right->at(0, 0), 13 - static_cast<int>(i));
  }
}

TEST(PlayedBackwards, PlaysTheChosenFramesWithTheirIntervalsInTheOppositeOrder) {
  const ScratchFolder folder;
  WriteTumFolder(folder);  // colour at 1.000, 1.033, 1.100, 1.200 s
  const auto recorded = [&] { return OpenDataset(folder.path(), {.sensor = SensorKind::kMono}); };
  const auto played = PlayedBackwards(recorded(), {0, 1, 3});
  EXPECT_THAT(played->info().stamps_ns, ElementsAre(1'000'000'000, 1'167'000'000, 1'200'000'000));
  EXPECT_EQ(played->info().time_mirror_ns, 2'200'000'000);
  EXPECT_EQ(played->Read(0)->left.at(0, 0), 4);
  EXPECT_EQ(played->Read(1)->left.at(0, 0), 2);
  EXPECT_EQ(played->Read(2)->left.at(0, 0), 1);
  EXPECT_THAT(PlayedBackwards(recorded(), {1})->info().stamps_ns, ElementsAre(1'033'000'000));
}

TEST(PlayedBackwards, KeepsDepthWithItsImage) {
  const ScratchFolder folder;
  WriteTumFolder(folder);  // colour 1 and 3 have a depth image near in time, of 1 and 2 m
  const auto played = PlayedBackwards(OpenDataset(folder.path()), {0, 1});
  ASSERT_EQ(played->sensor(), SensorKind::kRgbd);
  EXPECT_EQ(played->Read(0)->left.at(0, 0), 3);
  EXPECT_FLOAT_EQ(played->Read(0)->depth->at(0, 0), 2);
  EXPECT_EQ(played->Read(1)->left.at(0, 0), 1);
  EXPECT_FLOAT_EQ(played->Read(1)->depth->at(0, 0), 1);
}

TEST(PlayedBackwards, KeepsColours) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  const ColorImage color{GrayImage(8, 6, 9), GrayImage(8, 6, 8), GrayImage(8, 6, 7)};
  const auto recorded = [&] { return OpenDataset(folder.path(), {.sensor = SensorKind::kMono}); };
  WriteColorPng(folder / "rgb/1.png", color);
  const auto played = PlayedBackwards(recorded(), {0, 1});
  EXPECT_TRUE((played->ReadColor(1)->at(7, 5) == Color{9, 8, 7}));
  EXPECT_TRUE((played->ReadColor(0)->at(7, 5) == Color{2, 2, 2}));
}

TEST(PlayedBackwards, KeepsTheGroundTruthWithItsImages) {
  const ScratchFolder folder;
  WriteKitti(folder);  // at 0, 0.1037, 0.2074 s and z = 0, 1, 2
  const auto recorded = OpenDataset(folder.path());
  const Trajectory truth = recorded->info().ground_truth->poses;
  const auto played = PlayedBackwards(OpenDataset(folder.path()), {1, 2});
  const Trajectory& moved = played->info().ground_truth->poses;
  EXPECT_TRUE(std::is_sorted(moved.begin(), moved.end(), [](const auto& a, const auto& b) {
    return a.stamp_ns < b.stamp_ns;
  }));
  for (const auto& [i, frame] : {std::pair{0, 2}, std::pair{1, 1}}) {
    const auto pose = InterpolateAt(moved, played->stamp_ns(static_cast<std::size_t>(i)), 0);
    ASSERT_TRUE(pose) << i;
    EXPECT_EQ(pose->translation.z(), frame);
  }
  ASSERT_EQ(moved.size(), truth.size());
  EXPECT_EQ(moved.back().stamp_ns, 311'100'000) << "a pose before the first chosen frame";
}

TEST(PlayedBackwards, SaysWhichImageCannotBeRead) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  folder.Write("mav0/cam0/data/3.png", "not an image");
  const auto played = PlayedBackwards(OpenDataset(folder.path()), {0, 1, 2});
  const auto frame = played->Read(0);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().path.filename(), "3.png");
  EXPECT_TRUE(played->Read(1));
}

}  // namespace
}  // namespace plumbline
