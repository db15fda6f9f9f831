// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/ground_truth.h"

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
using testing::IsEmpty;

const std::string kEurocTruth = "mav0/state_groundtruth_estimate0/data.csv";

// The data set of a folder as `write` makes it, with another file of ground truth.
std::unique_ptr<Dataset> OpenWithTruth(const ScratchFolder& folder,
                                       void (*write)(const ScratchFolder&),
                                       const std::string& file,
                                       const std::string& content) {
  write(folder);
  folder.Write(file, content);
  return OpenDataset(folder.path());
}

std::vector<std::int64_t> StampsOf(const GroundTruth& truth) {
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : truth.poses) stamps.push_back(pose.stamp_ns);
  return stamps;
}

// What is wrong with a reference as a whole is its fault, and nothing else of the data's.
TEST(GroundTruth, AFaultRefusesNothingElse) {
  struct Case {
    void (*write)(const ScratchFolder&);
    std::string file;
    std::string content;
    std::string fault;
  };
  const std::string tum = "groundtruth.txt", kitti = "poses.txt", row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::vector<Case> cases = {
      {WriteTumFolder, tum, "", "groundtruth.txt: expected poses, found no rows"},
      {WriteTumFolder, tum, "# time\n", "groundtruth.txt: expected poses, found no rows"},
      {WriteTumFolder, tum, "1 2 3\n", "groundtruth.txt:1: expected 8 columns (TUM)"},
      {WriteTumFolder,
       tum,
       "# nine columns\n1 0 0 0 0 0 0 1 9\n2 0 0 0 0 0 0 1 9\n",
       "groundtruth.txt:2: expected 8 columns (TUM), 12 (KITTI) or commas between them (EuRoC), "
       "found 9 columns"},
      {WriteTumFolder,
       tum,
       "1.5,0,0,0,0,0,0,1\n1.6,0,0,0,0,0,0,1\n",
       "groundtruth.txt:1: expected a time stamp in whole nanoseconds, found '1.5'"},
      {WriteTumFolder, tum, "time tx ty tz qx qy qz qw\n", "groundtruth.txt:1: expected a time"},
      {WriteTumFolder,
       tum,
       "1 nan nan nan 0 0 0 1\n2 nan nan nan 0 0 0 1\n",
       "groundtruth.txt:1: expected a number in column 2, found 'nan'"},
      {WriteEuroc, kEurocTruth, "", "estimate0/data.csv: expected poses, found no rows"},
      {WriteEuroc,
       kEurocTruth,
       "100 1 2 3 1 0 0\n",
       "estimate0/data.csv:1: expected 8 columns (TUM), 12 (KITTI)"},
      {WriteEuroc, kEurocTruth, "100,1,2,3,1,0,0\n", "data.csv:1: expected at least 8 columns"},
      {WriteEuroc, kEurocTruth, "100,1,2,3,1,1,0,0\n", "data.csv:1: expected a unit quaternion"},
      {WriteKitti, kitti, row, "poses.txt: expected 3 poses, one for each time, found 1"},
      {WriteKitti, kitti, row + row + row + row, "poses.txt: expected 3 poses, one for each time"},
      {WriteKitti, kitti, "", "poses.txt: expected poses, found no rows"}};
  for (const Case& c : cases) {
    const ScratchFolder folder;
    const auto dataset = OpenWithTruth(folder, c.write, c.file, c.content);
    EXPECT_FALSE(dataset->info().ground_truth) << c.content;
    ASSERT_TRUE(dataset->info().ground_truth_fault) << c.content;
    EXPECT_THAT(*dataset->info().ground_truth_fault, HasSubstr(c.fault)) << c.content;
    EXPECT_TRUE(dataset->Read(0)) << c.content;
  }
}

TEST(GroundTruth, WhatIsNoFileRefusesNothingEither) {
  const ScratchFolder folder;
  WriteTumFolder(folder);
  fs::remove(folder / "groundtruth.txt");
  fs::create_directories(folder / "groundtruth.txt");
  EXPECT_THAT(OpenDataset(folder.path())->info().ground_truth_fault.value_or(""),
              HasSubstr("groundtruth.txt: expected a file, found a folder"));
  fs::remove(folder / "groundtruth.txt");
  // What cannot be looked at is not as good as missing: it would be left out unsaid.
  fs::create_symlink(folder / "groundtruth.txt", folder / "groundtruth.txt");  // to itself
  EXPECT_THAT(OpenDataset(folder.path())->info().ground_truth_fault.value_or(""),
              HasSubstr("groundtruth.txt: cannot be read: Too many levels"));
  fs::remove(folder / "groundtruth.txt");
  const auto dataset = OpenDataset(folder.path());
  EXPECT_FALSE(dataset->info().ground_truth || dataset->info().ground_truth_fault);
}

// freiburg2_desk has a time twice. A row that cannot be used loses itself alone.
TEST(GroundTruth, RowsThatCannotBeUsedAreLeftOut) {
  const std::string good = "1.0 0 0 0 0 0 0 1\n", end = "1.3 0 0 0 0 0 0 1\n";
  struct Case {
    std::string rows;
    std::string note;
  };
  const std::vector<Case> cases = {
      {"1.0 9 9 9 0 0 0 1\n", ":2: 1 row repeats a time stamp and is left out"},
      {"0.9 9 9 9 0 0 0 1\n", ":2: 1 row goes back in time and is left out"},
      {"0.9 9 9 9 0 0 0 1\n0.95 9 9 9 0 0 0 1\n",
       ":2: 2 rows go back in time and are left out, this one first"},
      {"1.1 nan 9 9 0 0 0 1\n",
       ":2: expected a number in column 2, found 'nan'; this row is left out"},
      {"1.1 0 0 0 0 0 0 1 9\n",
       ":2: expected 8 columns (time tx ty tz qx qy qz qw), found 9 columns; this row is left out"},
      {"1.1 0 0 0 0 0 0 0\n1.2 0 0 0 0 0 0 0\n",
       ":2: expected a unit quaternion, found one of norm 0; 2 rows that cannot be used are left "
       "out"}};
  for (const Case& c : cases) {
    const ScratchFolder folder;
    const auto dataset =
        OpenWithTruth(folder, WriteTumFolder, "groundtruth.txt", good + c.rows + end);
    ASSERT_TRUE(dataset->info().ground_truth) << c.rows;
    EXPECT_FALSE(dataset->info().ground_truth_fault) << c.rows;
    EXPECT_THAT(StampsOf(*dataset->info().ground_truth), ElementsAre(1'000'000'000, 1'300'000'000));
    EXPECT_THAT(dataset->info().notes.back(), EndsWith("groundtruth.txt" + c.note)) << c.rows;
  }
}

TEST(GroundTruth, AHeaderAndACutLastRowAreLeftOut) {
  const ScratchFolder tum, euroc;
  const auto of_tum = OpenWithTruth(tum,
                                    WriteTumFolder,
                                    "groundtruth.txt",
                                    "timestamp tx ty tz qx qy qz qw\n1 0 0 0 0 0 0 1\n2 0 0\n");
  EXPECT_THAT(StampsOf(*of_tum->info().ground_truth), ElementsAre(1'000'000'000));
  EXPECT_THAT(of_tum->info().notes.back(),
              EndsWith("groundtruth.txt:1: expected a time stamp in seconds, found 'timestamp'; "
                       "2 rows that cannot be used are left out"));
  // Its columns are named with blanks, and more than those of a pose.
  const auto of_euroc = OpenWithTruth(
      euroc, WriteEuroc, kEurocTruth, "time [ns], p x, p y [m]\n100,1,2,3,1,0,0,0\n200,1,2\n");
  EXPECT_THAT(StampsOf(*of_euroc->info().ground_truth), ElementsAre(100));
  EXPECT_THAT(of_euroc->info().notes.back(), HasSubstr("data.csv:1: expected at least 8 columns"));
}

TEST(GroundTruth, AKittiPoseStaysWithItsImage) {
  const ScratchFolder folder;
  const auto dataset = OpenWithTruth(folder,
                                     WriteKitti,
                                     "poses.txt",
                                     "1 0 0 0 0 1 0 0 0 0 1 0\nnan 0 0 0 0 1 0 0 0 0 1 1\n"
                                     "1 0 0 0 0 1 0 0 0 0 1 2\n");
  const GroundTruth& truth = *dataset->info().ground_truth;
  EXPECT_THAT(StampsOf(truth), ElementsAre(0, 207'400'000));
  EXPECT_EQ(truth.poses[1].world_from_camera.translation.z(), 2);
  EXPECT_THAT(dataset->info().notes,
              ElementsAre(EndsWith("poses.txt:2: expected a number in column 1, found 'nan'; this "
                                   "row is left out")));
}

// A file that is asked for takes the place of the delivered one; nothing of it is optional.
TEST(GroundTruth, AFileInItsPlace) {
  const ScratchFolder folder;
  WriteEuroc(folder);
  folder.Write(kEurocTruth, "broken\n");
  const auto file = folder.Write("own.txt", "0.0000001 1 2 3 0 0 0 1\n0.0000001 9 9 9 0 0 0 1\n");
  const auto dataset = OpenDataset(folder.path(), {.ground_truth = file.string()});
  ASSERT_TRUE(dataset->info().ground_truth);
  EXPECT_FALSE(dataset->info().ground_truth_fault);
  EXPECT_EQ(dataset->info().ground_truth->path, file);
  EXPECT_EQ(dataset->info().ground_truth->frame, GroundTruth::Frame::kBody);
  EXPECT_THAT(dataset->info().notes, ElementsAre(HasSubstr("own.txt:2: 1 row repeats")));
  const auto none = OpenDataset(folder.path(), {.ground_truth = "none"});
  EXPECT_FALSE(none->info().ground_truth || none->info().ground_truth_fault);
  EXPECT_THAT(none->info().notes, IsEmpty());
  const auto message = [&](const std::string& path) {
    return MessageOf([&] { OpenDataset(folder.path(), {.ground_truth = path}); });
  };
  EXPECT_THAT(message(folder / "missing.txt"), HasSubstr("missing.txt: no such file"));
  EXPECT_THAT(message(folder.path()), HasSubstr("expected a file, found a folder"));
  EXPECT_THAT(message(folder.Write("bad.txt", "1 2 3\nx\n")), HasSubstr("bad.txt:1: expected 8"));
}

TEST(GroundTruth, AFileForDataThatHasNone) {
  const ScratchFolder folder;
  for (const int i : {1, 2}) folder.Write("images/" + std::to_string(i) + ".png", Png(8, 6, i));
  folder.Write("images/camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 10\n");
  const auto file = folder.Write("truth.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 1 0 0 0 1\n");
  const auto dataset = OpenDataset(folder / "images", {.ground_truth = file.string()});
  ASSERT_TRUE(dataset->info().ground_truth);
  EXPECT_EQ(dataset->info().ground_truth->frame, GroundTruth::Frame::kCamera);
  EXPECT_EQ(dataset->info().ground_truth->poses.size(), 2U);
}

TEST(GroundTruth, KittiPosesAskedForHaveTheTimesOfTheImages) {
  const ScratchFolder folder;
  WriteKitti(folder);
  const std::string rows = Contents(folder / "poses.txt");
  const auto file = folder.Write("elsewhere/refined.txt", rows);
  const auto dataset = OpenDataset(folder.path(), {.ground_truth = file.string()});
  EXPECT_THAT(StampsOf(*dataset->info().ground_truth), ElementsAre(0, 103'700'000, 207'400'000));
}

}  // namespace
}  // namespace plumbline
