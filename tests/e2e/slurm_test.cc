// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/support/slurm_cluster.h"
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A cluster, and data/euroc/poster of 12 frames.
class SlurmExperiment : public testing::Test {
 protected:
  void SetUp() override {
    if (!SlurmCluster::IsWanted()) GTEST_SKIP() << "./test --full runs it";
    cluster_ = std::make_unique<SlurmCluster>();
    ASSERT_TRUE(cluster_->works()) << cluster_->Log();
    fs::create_directories(folder_ / "data/euroc");
    fs::rename(WritePosterSequence(folder_, 12), folder_ / "data/euroc/poster");
  }

  // So long that there is time to do something meanwhile: with slam.mode=live, a second for 20
  // frames.
  void MakeLong(int frames) {
    for (const char* camera : {"cam0", "cam1"}) {
      folder_.Write("data/euroc/poster/mav0/" + std::string(camera) + "/data.csv",
                    PosterList(frames));
    }
  }

  std::string Arguments(const std::string& more, const std::string& out) const {
    return "experiment sensors --data " + Quoted(folder_ / "data") + " --out " +
           Quoted(folder_ / out) + " --only euroc/poster " + more;
  }
  std::string OnSlurm(const std::string& more, const std::string& out = "out") const {
    return Arguments("--executor slurm --sbatch --cpus-per-task=1 " + more, out);
  }
  std::size_t Submitted(const std::string& out = "out") const {
    std::size_t batches = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / (out + "/slurm"))) {
      batches += entry.path().extension() == ".json";
    }
    return batches;
  }
  // Address space in MB with which the program starts and says what is wrong with a sequence. Its
  // threads and images take more.
  int MemoryToRead(const std::string& broken) const {
    constexpr int kStep = 10, kMost = 1000;
    for (int mb = kStep; mb < kMost; mb += kStep) {
      const Outcome outcome = RunProgram(
          folder_,
          "run " + Quoted(folder_ / "data/euroc" / broken) + " --out " + Quoted(folder_ / "tried"),
          fmt::format("ulimit -v {}; ", mb * 1024));
      if (outcome.err.find("expected") != std::string::npos) return mb + kStep;
    }
    return 0;
  }
  // Node of a run that is under way.
  std::string NodeOfARun() const {
    std::string node;
    SlurmCluster::Until([&] {
      node = cluster_->Say("squeue -h -t R -o %N");
      return !node.empty();
    });
    return node.substr(0, node.find('\n'));
  }

  ScratchFolder folder_;
  std::unique_ptr<SlurmCluster> cluster_;
};

TEST_F(SlurmExperiment, GivesTheSameResultsAsThisMachine) {
  const std::string more = "--runs 2 --quiet --set slam.mode=inline";
  const Outcome here = RunProgram(folder_, Arguments(more, "here"));
  ASSERT_EQ(here.code, 0) << here.err;
  const Outcome there = RunProgram(folder_, OnSlurm(more));
  ASSERT_EQ(there.code, 0) << there.err << cluster_->Log();
  EXPECT_EQ(Contents(folder_ / "here/results.json"), Contents(folder_ / "out/results.json"));
  EXPECT_EQ(Submitted(), 1U);
  EXPECT_THAT(Contents(folder_ / "out/results.json"), HasSubstr("\"value\""));
}

TEST_F(SlurmExperiment, ACollectorThatIsKilledGoesOnWhereItWas) {
  MakeLong(300);
  const std::string more = "--runs 2 --quiet";
  std::vector<std::string> words = {"experiment",
                                    "sensors",
                                    "--data",
                                    (folder_ / "data").string(),
                                    "--out",
                                    (folder_ / "out").string(),
                                    "--only",
                                    "euroc/poster",
                                    "--executor",
                                    "slurm",
                                    "--sbatch",
                                    "--cpus-per-task=1",
                                    "--runs",
                                    "2",
                                    "--quiet"};
  const pid_t collector = StartProgram(words);
  ASSERT_NE(NodeOfARun(), "") << cluster_->Log();
  ::kill(collector, SIGKILL);
  ::waitpid(collector, nullptr, 0);
  const Outcome outcome = RunProgram(folder_, OnSlurm(more));
  ASSERT_EQ(outcome.code, 0) << outcome.err << cluster_->Log();
  EXPECT_EQ(Submitted(), 1U) << "nothing is submitted twice";
  const auto results = nlohmann::json::parse(Contents(folder_ / "out/results.json"));
  EXPECT_TRUE(std::any_of(results.begin(), results.end(), [](const auto& row) {
    return row["seed"] == 2 && row["metric"] == "ate" && row["value"].is_number();
  }));
}

TEST_F(SlurmExperiment, ANodeThatDiesCostsATryAndTheRestGoesOn) {
  MakeLong(300);
  std::vector<std::string> words = {"experiment",
                                    "sensors",
                                    "--data",
                                    (folder_ / "data").string(),
                                    "--out",
                                    (folder_ / "out").string(),
                                    "--only",
                                    "euroc/poster/points",
                                    "--executor",
                                    "slurm",
                                    "--sbatch",
                                    "--cpus-per-task=1",
                                    "--runs",
                                    "1",
                                    "--set",
                                    "slam.mode=live",
                                    "--quiet"};
  const pid_t collector = StartProgram(words);
  // A run that has begun: Slurm tells of it as running before.
  ASSERT_TRUE(WaitForFile(folder_ / "out/runs/euroc/poster/points/1/log.txt")) << cluster_->Log();
  const std::string node = NodeOfARun();
  ASSERT_NE(node, "") << cluster_->Log();
  cluster_->KillNode(node == "n1" ? 1 : 2);
  int status = 0;
  ::waitpid(collector, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const std::string table = Contents(folder_ / "out/table.md");
  EXPECT_THAT(table, HasSubstr("| euroc/poster | points | 1 |")) << cluster_->Log();
  EXPECT_THAT(table, HasSubstr("tried again after: euroc/poster, points, 1 failure: "));
  EXPECT_EQ(Submitted(), 2U);
}

TEST_F(SlurmExperiment, TooLittleMemoryAndABrokenSequenceAreReasonsInTheTable) {
  fs::create_directories(folder_ / "data/euroc/poster_broken");
  fs::copy(folder_ / "data/euroc/poster",
           folder_ / "data/euroc/poster_broken",
           fs::copy_options::recursive);
  folder_.Write("data/euroc/poster_broken/mav0/cam0/data.csv", "now,1.png\n");
  const int memory = MemoryToRead("poster_broken");
  const std::string more = fmt::format("--runs 1 --quiet --memory {}", memory);
  for (const std::string& command : {Arguments(more, "here"), OnSlurm(more)}) {
    const Outcome outcome = RunProgram(folder_, command);
    ASSERT_EQ(outcome.code, 1) << outcome.err << cluster_->Log();
    EXPECT_THAT(outcome.err, HasSubstr("plumbline: no run succeeded; "));
  }
  EXPECT_EQ(Contents(folder_ / "here/results.json"), Contents(folder_ / "out/results.json"));
  for (const char* out : {"here", "out"}) {
    const std::string table = Contents(folder_ / out / "table.md");
    EXPECT_THAT(table,
                HasSubstr(fmt::format(
                    "failed: euroc/poster, points, 1 run: out of memory (limit {} MB)", memory)));
    EXPECT_THAT(table,
                HasSubstr("failed: euroc/poster_broken, points, 1 run: euroc/poster_broken/mav0/"
                          "cam0/data.csv:1: expected a time stamp in whole nanoseconds"));
  }
}

}  // namespace
}  // namespace plumbline
