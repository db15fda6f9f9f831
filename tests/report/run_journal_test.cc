// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_journal.h"

#include "plumbline/report/run_files.h"

#include "tests/io/scratch_folder.h"
#include "tests/report/poster_run.h"
#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Frame `i` at second `i`, one metre further than the one before.
FrameRecord Tracked(int i, int map = 0, bool keyframe = false) {
  FrameRecord record;
  record.id = FrameId{i};
  record.stamp_ns = i * 1'000'000'000LL;
  record.status = FrameStatus::kTracked;
  record.map = MapId{map};
  record.keyframe = keyframe;
  record.causal_world_from_camera =
      Rigid3{Eigen::Quaterniond::Identity(), Eigen::Vector3d(i, 0, 0)};
  return record;
}

std::string Row(int i) {
  return std::to_string(i) + ".000000000 " + std::to_string(i) +
         ".000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 1.000000000\n";
}

TEST(RunJournal, IsTheCausalTrajectoryAndTheTableOfARun) {
  const PosterRun run;
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  for (const FrameRecord& record : run.system().frames()) journal.Add(record);
  EXPECT_FALSE(journal.Write(folder));
  for (const RunFile& file : PoseFiles(run.system())) file.write(scratch / file.name);
  for (const char* name : {"trajectory_causal.txt", "frames.csv"}) {
    EXPECT_EQ(Contents(folder.part() / name), Contents(scratch / name)) << name;
  }
  EXPECT_GT(Contents(folder.part() / "keyframes.txt").size(), 50U);
}

TEST(RunJournal, GrowsAndIsWholeEachTime) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), "");
  EXPECT_EQ(Contents(folder.part() / "frames.csv"), FormatFrames({}));
  journal.Add(Tracked(1, 0, true));
  journal.Write(folder);
  journal.Add(Tracked(2));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1));
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1) + Row(2));
  EXPECT_EQ(Contents(folder.part() / "keyframes.txt"), Row(1));
}

TEST(RunJournal, ThePlainNamesGoToTheMapWithMostFrames) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  for (const int i : {1, 2}) journal.Add(Tracked(i, 0));
  journal.Add(Tracked(3, 1));
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal_map1.txt"), Row(3));
  for (const int i : {4, 5}) journal.Add(Tracked(i, 1));
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(3) + Row(4) + Row(5));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal_map0.txt"), Row(1) + Row(2));
  EXPECT_FALSE(fs::exists(folder.part() / "trajectory_causal_map1.txt"));
}

TEST(RunJournal, IsWrittenAgainAfterAWhile) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  journal.Write(folder);
  journal.Add(Tracked(1));
  const auto now = RunJournal::Clock::now();
  journal.WriteIfDue(folder, now);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), "");
  journal.WriteIfDue(folder, now + std::chrono::hours(1));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1));
}

TEST(RunJournal, ComesBackAfterItsFolderWasRemoved) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  journal.Add(Tracked(1));
  journal.Write(folder);
  fs::remove_all(scratch / "out");
  journal.Add(Tracked(2));
  EXPECT_FALSE(journal.Write(folder));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1) + Row(2));
}

TEST(RunJournal, SaysOnceWhyItCannotBeWritten) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  fs::create_directory(folder.part() / "trajectory_causal.txt");
  RunJournal journal;
  journal.Add(Tracked(1));
  EXPECT_THAT(journal.Write(folder).value_or(""), HasSubstr("trajectory_causal.txt"));
  EXPECT_FALSE(journal.Write(folder));
  fs::remove(folder.part() / "trajectory_causal.txt");
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1));
}

}  // namespace
}  // namespace plumbline
