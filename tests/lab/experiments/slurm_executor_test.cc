// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/slurm_executor.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/slurm_cluster.h"
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace slurm_executor_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

JobTask Shell(const ScratchFolder& folder, const std::string& name, const std::string& script) {
  JobTask task;
  task.command = {"/bin/sh", "-c", script};
  task.folder = folder / ("runs/" + name);
  task.name = name;
  task.key = "key of " + name;
  task.limit_s = 60;
  fs::create_directories(task.folder);
  return task;
}

// Programs in place of Slurm's, first in the PATH while it lives. sbatch notes its arguments in
// `calls` and does what the file `sbatch.sh` says, with NAME and SCRIPT; squeue prints `states`.
class FakeSlurm {
 public:
  explicit FakeSlurm(const ScratchFolder& folder) : folder_(folder) {
    const std::string at = folder.path().string();
    Program("sbatch",
            "echo \"sbatch $*\" >> '" + at +
                "/calls'\nfor a in \"$@\"; do case $a in --job-name=*) NAME=${a#*=};; "
                "--array=0-*) LAST=${a#*-}; LAST=${LAST#*-};; esac; SCRIPT=$a; done\n"
                "LAST=${LAST##*-}\nexport NAME SCRIPT LAST\n. '" +
                at + "/sbatch.sh'\necho 1\n");
    Program("squeue", "cat '" + at + "/states' 2>/dev/null\n");
    Program("scancel", "echo \"scancel $*\" >> '" + at + "/calls'\n: > '" + at + "/states'\n");
    // NOLINTBEGIN(concurrency-mt-unsafe): tests have one thread
    path_ = std::getenv("PATH");
    ::setenv("PATH", (at + "/bin:" + path_).c_str(), 1);
    // NOLINTEND(concurrency-mt-unsafe)
    RunThem();
  }
  FakeSlurm(const FakeSlurm&) = delete;
  FakeSlurm& operator=(const FakeSlurm&) = delete;
  ~FakeSlurm() { ::setenv("PATH", path_.c_str(), 1); }  // NOLINT(concurrency-mt-unsafe)

  // What is submitted is run at once.
  void RunThem() const {
    Sbatch("for i in $(seq 0 $LAST); do SLURM_ARRAY_TASK_ID=$i bash $SCRIPT; done");
  }
  void Sbatch(const std::string& script) const { folder_.Write("sbatch.sh", script + "\n"); }
  // The state of the first task of whatever is submitted next: "RUNNING|n1".
  void StateOfNext(const std::string& state) const {
    Sbatch("echo \"$NAME|0|" + state + "\" > '" + (folder_ / "states").string() + "'");
  }
  std::string Calls() const { return Contents(folder_ / "calls"); }

 private:
  void Program(const std::string& name, const std::string& script) const {
    fs::permissions(folder_.Write("bin/" + name, "#!/bin/bash\n" + script), fs::perms::owner_all);
  }

  const ScratchFolder& folder_;
  std::string path_;
};

// The ends of so many tasks, by number.
std::map<std::size_t, TaskEnd> WaitFor(SlurmExecutor& executor, std::size_t count) {
  std::map<std::size_t, TaskEnd> ends;
  for (int i = 0; i < 600 && ends.size() < count; ++i) {
    for (const auto& ended : executor.Poll()) ends[ended.id] = ended.end;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return ends;
}

TEST(SlurmExecutor, TasksOfAnArrayEndAsTheirProgramsDo) {
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  SlurmExecutor executor({folder / "slurm", {"--partition=long"}});
  executor.Add(0, Shell(folder, "well", "echo it\\'s \"done\"; ulimit -v"));
  executor.Add(1, Shell(folder, "badly", "exit 3"));
  executor.Add(2, Shell(folder, "crash", "kill -SEGV $$"));
  JobTask hangs = Shell(folder, "hangs", "sleep 30");
  hangs.limit_s = 1;
  executor.Add(3, hangs);
  executor.Submit();
  auto ends = WaitFor(executor, 4);
  ASSERT_EQ(ends.size(), 4U);
  EXPECT_EQ(ends[0].code, 0);
  EXPECT_EQ(Contents(LogOf(folder / "runs/well")), "it's done\nunlimited\n");
  EXPECT_EQ(ends[1].code, 3);
  EXPECT_EQ(ends[2].signal, 11);
  EXPECT_EQ(ends[3].trouble, "no end after 1 s");
  EXPECT_FALSE(ends[3].by_machine);
  EXPECT_THAT(slurm.Calls(), HasSubstr("--no-requeue"));
  EXPECT_THAT(slurm.Calls(), HasSubstr("--array=0-3"));
  EXPECT_THAT(slurm.Calls(), HasSubstr("--partition=long"));
  EXPECT_EQ(executor.WhatGoesOn(), "");
}

TEST(SlurmExecutor, ExclusiveTasksAndThoseWithOtherMemoryAreArraysOfTheirOwn) {
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  SlurmExecutor executor({folder / "slurm", {}});
  JobTask small = Shell(folder, "small", "ulimit -v"), timed = Shell(folder, "timed", "true");
  small.memory_mb = 200;
  timed.exclusive = true;
  executor.Add(0, Shell(folder, "usual", "true"));
  executor.Add(1, small);
  executor.Add(2, timed);
  executor.Submit();
  EXPECT_EQ(WaitFor(executor, 3).size(), 3U);
  const std::string calls = slurm.Calls();
  EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 3);
  EXPECT_THAT(calls, HasSubstr("--mem=200"));
  EXPECT_THAT(calls, HasSubstr("--exclusive"));
  EXPECT_EQ(Contents(LogOf(folder / "runs/small")), "204800\n");
}

TEST(SlurmExecutor, ATaskWithoutAnEndIsWhatSlurmSaysBecameOfIt) {
  struct Case {
    const char *state, *trouble;
    bool by_machine;
  };
  const std::vector<Case> cases = {{"NODE_FAIL|n2", "its node n2 went away (NODE_FAIL)", true},
                                   {"OUT_OF_MEMORY|n1", "out of memory", false},
                                   {"CANCELLED|", "cancelled in the queue", false},
                                   {"FAILED|n1", "killed on its node (FAILED)", true}};
  // All wait together for the delay of a file system.
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  slurm.Sbatch(
      "{ echo \"$NAME|0|NODE_FAIL|n2\"; echo \"$NAME|1|OUT_OF_MEMORY|n1\"; echo "
      "\"$NAME|2|CANCELLED|\"; echo \"$NAME|3|FAILED|n1\"; } > '" +
      (folder / "states").string() + "'");
  SlurmExecutor executor({folder / "slurm", {}});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    executor.Add(i, Shell(folder, std::to_string(i), "true"));
  }
  executor.Submit();
  const auto ends = WaitFor(executor, cases.size());
  ASSERT_EQ(ends.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(ends.at(i).trouble, cases[i].trouble) << cases[i].state;
    EXPECT_EQ(ends.at(i).by_machine, cases[i].by_machine) << cases[i].state;
  }
}

TEST(SlurmExecutor, AnotherCollectorFindsWhatTheFirstOneSubmitted) {
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  const JobTask task = Shell(folder, "a", "true");
  slurm.StateOfNext("RUNNING|n1");
  {
    SlurmExecutor killed({folder / "slurm", {}});
    killed.Add(0, task);
    killed.Submit();
    killed.Poll();
    EXPECT_EQ(killed.Running(), 1U);
    EXPECT_THAT(killed.WhatGoesOn(), HasSubstr("scancel --name=plumbline-"));
  }
  SlurmExecutor next({folder / "slurm", {}});
  next.Add(7, task);
  next.Submit();
  EXPECT_THAT(next.Poll(), testing::IsEmpty());
  // It ends now.
  const std::string state = Contents(folder / "states");
  folder.Write("runs/a/end.txt", state.substr(0, state.find('|')) + " 0 0 12\n");
  auto ends = WaitFor(next, 1);
  ASSERT_TRUE(ends.contains(7));
  EXPECT_EQ(ends[7].seconds, 12);
  std::string calls = slurm.Calls();
  EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 1) << "submitted once";
  // What has been seen to end is submitted anew when it is asked for again.
  slurm.RunThem();
  folder.Write("states", "");
  SlurmExecutor third({folder / "slurm", {}});
  third.Add(0, task);
  third.Submit();
  EXPECT_EQ(WaitFor(third, 1).size(), 1U);
  calls = slurm.Calls();
  EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 2);
  EXPECT_THAT(calls, Not(HasSubstr("scancel")));
}

TEST(SlurmExecutor, ATaskOfAnotherKeyInTheSameFolderIsCancelled) {
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  JobTask task = Shell(folder, "a", "true");
  slurm.StateOfNext("RUNNING|n1");
  {
    SlurmExecutor first({folder / "slurm", {}});
    first.Add(0, task);
    first.Submit();
  }
  slurm.RunThem();
  task.key = "another build";
  SlurmExecutor second({folder / "slurm", {}});
  // squeue of this test prints the same whatever it is asked: the state's line ends with n1, not
  // with an index; the array task is named in another form.
  const std::string state = Contents(folder / "states");
  folder.Write("states", state + "1_0\n");
  second.Add(0, task);
  second.Submit();
  EXPECT_EQ(WaitFor(second, 1).size(), 1U);
  EXPECT_THAT(slurm.Calls(), HasSubstr("scancel 1_0"));
}

TEST(SlurmExecutor, TellsWhatSbatchSays) {
  const ScratchFolder folder;
  const FakeSlurm slurm(folder);
  slurm.Sbatch("echo 'sbatch: error: invalid partition' >&2; exit 1");
  SlurmExecutor executor({folder / "slurm", {}});
  executor.Add(0, Shell(folder, "a", "true"));
  EXPECT_THAT(MessageOf([&] { executor.Submit(); }), HasSubstr("invalid partition"));
  folder.Write("slurm/plumbline-x.json", "[{\"folder\": 1}]");
  EXPECT_THAT(MessageOf([&] {
                SlurmExecutor({folder / "slurm", {}});
              }),
              HasSubstr("plumbline-x.json: expected a list of submitted tasks"));
}

// On a cluster of two nodes.

TEST(SlurmExecutor, OnAClusterTasksEndAndANodeThatDiesIsTold) {
  if (!SlurmCluster::IsWanted()) GTEST_SKIP() << "./test --full runs it";
  SlurmCluster cluster;
  ASSERT_TRUE(cluster.works()) << cluster.Log();
  const ScratchFolder folder;
  SlurmExecutor executor({folder / "slurm", {"--cpus-per-task=1"}});
  executor.Add(0, Shell(folder, "well", "echo $SLURMD_NODENAME; exit 0"));
  executor.Add(1, Shell(folder, "badly", "exit 3"));
  executor.Add(2, Shell(folder, "crash", "kill -SEGV $$"));
  executor.Submit();
  auto ends = WaitFor(executor, 3);
  ASSERT_EQ(ends.size(), 3U) << cluster.Log();
  EXPECT_EQ(ends[0].code, 0);
  EXPECT_THAT(Contents(LogOf(folder / "runs/well")), HasSubstr("n"));
  EXPECT_EQ(ends[1].code, 3);
  EXPECT_EQ(ends[2].signal, 11);
  // More than Slurm was told of, past the limit that a program can see: in files of memory. Slurm
  // looks every second and kills it.
  JobTask greedy = Shell(folder, "greedy", "exec tail /dev/zero");
  greedy.memory_mb = 100;
  executor.Add(3, greedy);
  executor.Submit();
  ends = WaitFor(executor, 1);
  ASSERT_TRUE(ends.contains(3));
  EXPECT_TRUE(ends[3].code != 0 || ends[3].signal || !ends[3].trouble.empty());
  // A node dies with what runs on it.
  executor.Add(4, Shell(folder, "long", "echo $SLURMD_NODENAME; exec sleep 120"));
  executor.Submit();
  const fs::path log = LogOf(folder / "runs/long");
  const auto said = [&] { return fs::exists(log) ? Contents(log) : ""; };
  ASSERT_TRUE(SlurmCluster::Until([&] { return said().ends_with('\n'); })) << cluster.Log();
  cluster.KillNode(said() == "n1\n" ? 1 : 2);
  ends = WaitFor(executor, 1);
  ASSERT_TRUE(ends.contains(4)) << cluster.Log();
  EXPECT_TRUE(ends[4].by_machine) << ends[4].trouble;
}

}  // namespace slurm_executor_test
}  // namespace plumbline
