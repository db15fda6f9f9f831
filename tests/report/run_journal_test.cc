// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_journal.h"

#include "plumbline/report/run_files.h"

#include "tests/io/scratch_folder.h"
#include "tests/report/poster_run.h"
#include <csignal>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

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
  for (const FrameRecord& record : run.result().frames) journal.Add(record);
  EXPECT_FALSE(journal.Write(folder));
  for (const RunFile& file : PoseFiles(run.result())) file.write(scratch / file.name);
  for (const char* name : {"trajectory_causal.txt", "frames.csv"}) {
    EXPECT_EQ(Contents(folder.part() / name), Contents(scratch / name)) << name;
  }
  EXPECT_GT(Contents(folder.part() / "keyframes.txt").size(), 50U);
}

TEST(RunJournal, GrowsByWhatIsNew) {
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

TEST(RunJournal, ThePlainNamesGoToTheFirstMap) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  journal.Add(Tracked(1, 3, true));
  journal.Add(Tracked(2, 4));
  journal.Write(folder);
  journal.Add(Tracked(3, 4, true));
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal_map4.txt"), Row(2) + Row(3));
  EXPECT_EQ(Contents(folder.part() / "keyframes.txt"), Row(1));
  EXPECT_EQ(Contents(folder.part() / "keyframes_map4.txt"), Row(3));
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
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(2));
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
  journal.Add(Tracked(2));
  journal.Write(folder);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), Row(1) + Row(2));
}

// A limit on the size of files takes the part of a full disk.
TEST(RunJournal, HasWholeRowsWhereTheDiskIsFull) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  RunJournal journal;
  std::string rows;
  for (int i = 1; i <= 40; ++i) {
    journal.Add(Tracked(i));
    if (i > 20) continue;
    rows += Row(i);
    EXPECT_FALSE(journal.Write(folder));
  }
  const rlimit limit{rows.size() + 100, RLIM_INFINITY};
  rlimit before{};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto failure = journal.Write(folder);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(failure.value_or(""), HasSubstr("File too large"));
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), rows);
  journal.Write(folder);
  for (int i = 21; i <= 40; ++i) rows += Row(i);
  EXPECT_EQ(Contents(folder.part() / "trajectory_causal.txt"), rows);
}

}  // namespace
}  // namespace plumbline
