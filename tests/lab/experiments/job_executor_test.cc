// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/job_executor.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace plumbline {
namespace job_executor_test {

JobTask Shell(const ScratchFolder& folder, const std::string& name, const std::string& script) {
  JobTask task;
  task.command = {"/bin/sh", "-c", script};
  task.folder = folder / name;
  task.limit_s = 60;
  std::filesystem::create_directories(task.folder);
  return task;
}

TaskEnd WaitFor(LocalExecutor& executor) {
  for (;;) {
    const auto ended = executor.Poll();
    if (!ended.empty()) return ended.front().end;
    std::this_thread::sleep_for(executor.PollEvery());
  }
}

TEST(LocalExecutor, TellsHowTasksEnd) {
  const ScratchFolder folder;
  LocalExecutor executor(1);
  executor.Add(1, Shell(folder, "a", "echo said; exit 3"));
  EXPECT_EQ(executor.Running(), 1U);
  EXPECT_EQ(WaitFor(executor).code, 3);
  EXPECT_EQ(Contents(LogOf(folder / "a")), "said\n");
  executor.Add(2, Shell(folder, "b", "kill -SEGV $$"));
  EXPECT_EQ(WaitFor(executor).signal, 11);
  JobTask hangs = Shell(folder, "c", "sleep 60");
  hangs.limit_s = 0.2;
  executor.Add(3, hangs);
  const TaskEnd end = WaitFor(executor);
  EXPECT_EQ(end.trouble, NoEndAfter(0.2));
  EXPECT_FALSE(end.by_machine);
  EXPECT_EQ(executor.Running(), 0U);
}

TEST(LocalExecutor, HasRoomForSoManyAndNothingBesideAnExclusiveOne) {
  const ScratchFolder folder;
  LocalExecutor executor(2);
  const JobTask usual = Shell(folder, "a", "sleep 60");
  JobTask exclusive = usual;
  exclusive.exclusive = true;
  EXPECT_TRUE(executor.HasRoom(exclusive));
  executor.Add(1, usual);
  EXPECT_TRUE(executor.HasRoom(usual));
  EXPECT_FALSE(executor.HasRoom(exclusive));
  executor.Add(2, usual);
  EXPECT_FALSE(executor.HasRoom(usual));
  LocalExecutor other(2);
  other.Add(1, exclusive);
  EXPECT_FALSE(other.HasRoom(usual));
}

TEST(LocalExecutor, LimitsMemory) {
  const ScratchFolder folder;
  LocalExecutor executor(1);
  JobTask task = Shell(folder, "a", "ulimit -v");
  task.memory_mb = 300;
  executor.Add(1, task);
  WaitFor(executor);
  EXPECT_EQ(Contents(LogOf(folder / "a")), "307200\n");
}

}  // namespace job_executor_test
}  // namespace plumbline
