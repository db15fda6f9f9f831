// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// data/euroc/poster, a sequence of 12 frames.
fs::path WriteData(const ScratchFolder& folder) {
  fs::create_directories(folder / "data/euroc");
  fs::rename(WritePosterSequence(folder, 12), folder / "data/euroc/poster");
  return folder / "data/euroc/poster";
}

Outcome RunExperiment(const ScratchFolder& folder,
                      const std::string& more,
                      const char* out = "out") {
  return RunProgram(folder,
                    "experiment sensors --data " + Quoted(folder / "data") + " --out " +
                        Quoted(folder / out) + " " + more);
}

TEST(ExperimentCommand, ListsWhatThereIsAndWhatItWouldDo) {
  const ScratchFolder folder;
  WriteData(folder);
  EXPECT_THAT(RunProgram(folder, "experiment --list").out,
              HasSubstr("sensors                      points"));
  const Outcome parts = RunProgram(folder, "experiment sensors --list");
  EXPECT_THAT(parts.out, HasSubstr("worlds/* euroc/*"));
  EXPECT_THAT(parts.out, HasSubstr("features.lines=false"));
  const Outcome dry = RunExperiment(folder, "--runs 2 --only euroc/ --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_EQ(std::count(dry.out.begin(), dry.out.end(), '\n'), 6 + 1);
  EXPECT_THAT(dry.out, HasSubstr("6 runs, 0 done; the others take about "));
  EXPECT_THAT(dry.out, HasSubstr("run   euroc/poster/lines/2: plumbline run "));
  EXPECT_THAT(dry.err, HasSubstr("sensors: no sequence found for "));
  EXPECT_THAT(dry.err, HasSubstr("kitti/*"));
  EXPECT_EQ(std::count(dry.err.begin(), dry.err.end(), '\n'), 1) << dry.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(ExperimentCommand, SaysInOneLineThatAFolderHasNoRecordings) {
  const ScratchFolder folder;
  fs::create_directories(folder / "data");
  const Outcome worlds = RunExperiment(folder, "--dry-run");
  EXPECT_EQ(worlds.code, 0) << worlds.err;
  EXPECT_THAT(worlds.err, HasSubstr("data; only rendered ones are run\n"));
  EXPECT_EQ(std::count(worlds.err.begin(), worlds.err.end(), '\n'), 1) << worlds.err;
  const std::string arguments =
      " --dry-run --data " + Quoted(folder / "data") + " --out " + Quoted(folder / "out");
  const Outcome group = RunProgram(folder, "experiment controls" + arguments);
  EXPECT_EQ(group.code, 0) << group.err;
  EXPECT_THAT(group.err, HasSubstr("no recorded sequence found"));
  EXPECT_EQ(std::count(group.err.begin(), group.err.end(), '\n'), 1) << group.err;
  const Outcome recordings = RunProgram(folder, "experiment robustness" + arguments);
  EXPECT_EQ(recordings.code, 2);
  EXPECT_THAT(recordings.err, HasSubstr("robustness: no sequence found for "));
  EXPECT_EQ(std::count(recordings.err.begin(), recordings.err.end(), '\n'), 1) << recordings.err;
}

TEST(ExperimentCommand, MakesTheSameTablesTwice) {
  const ScratchFolder folder;
  WriteData(folder);
  for (const char* out : {"first", "second"}) {
    const Outcome outcome =
        RunExperiment(folder, "--runs 2 --only poster/points --set slam.mode=inline", out);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("2 runs; results in "));
    EXPECT_THAT(outcome.err, HasSubstr("2/2 runs"));
  }
  for (const char* name : {"results.json", "table.md", "plots/ate.svg"}) {
    EXPECT_EQ(Contents(folder / "first" / name), Contents(folder / "second" / name)) << name;
  }
  const auto results = nlohmann::json::parse(Contents(folder / "first/results.json"));
  EXPECT_EQ(results[0]["sequence"], "euroc/poster");
  EXPECT_EQ(results[0]["metric"], "ate");
  EXPECT_LT(results[0]["value"], 20);
  EXPECT_THAT(Contents(folder / "first/table.md"), HasSubstr("not there: no sequence tum/*"));
  EXPECT_THAT(Contents(folder / "first/table.html"), HasSubstr("<svg"));
  const auto timing = nlohmann::json::parse(Contents(folder / "first/timing.json"));
  EXPECT_GT(timing[0]["value"], 0);
  // The second time there is nothing to run.
  const Outcome again = RunExperiment(
      folder, "--runs 2 --only poster/points --set slam.mode=inline --dry-run", "first");
  EXPECT_THAT(again.out, Not(HasSubstr("run   ")));
  // The folder of a run is that of plumbline run, with what was asked for.
  const auto summary =
      nlohmann::json::parse(Contents(folder / "first/runs/euroc/poster/points/2/summary.json"));
  EXPECT_EQ(summary["seed"], 2);
  EXPECT_EQ(summary["frames"]["in"], 11);
  EXPECT_EQ(summary["mode"], "inline");
}

TEST(ExperimentCommand, ABrokenSequenceIsAFailureWithAReason) {
  const ScratchFolder folder;
  const fs::path sequence = WriteData(folder);
  fs::create_directories(folder / "data/euroc/broken");
  fs::copy(sequence, folder / "data/euroc/broken", fs::copy_options::recursive);
  folder.Write("data/euroc/broken/mav0/cam0/data.csv", "now,1.png\n");
  folder.Write("data/euroc/poster/mav0/cam0/data/3.png", "not an image");
  const Outcome outcome =
      RunExperiment(folder, "--runs 1 --only broken/points --only poster/points");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto results = nlohmann::json::parse(Contents(folder / "out/results.json"));
  EXPECT_EQ(results[0]["sequence"], "euroc/broken");
  EXPECT_TRUE(results[0]["value"].is_null());
  EXPECT_THAT(std::string(results[0]["reason"]),
              HasSubstr("euroc/broken/mav0/cam0/data.csv:1: expected a time stamp"));
  EXPECT_THAT(std::string(results[0]["reason"]), Not(HasSubstr(folder.path().string())));
  const std::string table = Contents(folder / "out/table.md");
  EXPECT_THAT(table, HasSubstr("| euroc/broken | points | 1 failed | - | - |"));
  EXPECT_THAT(table, HasSubstr("| euroc/poster | points | 1 |"));
  for (const auto& row : results) {
    if (row["sequence"] == "euroc/poster" && row["metric"] == "skipped") {
      EXPECT_EQ(row["value"], 1);
    }
  }
  // Where none succeeds, scripts are told.
  const Outcome none = RunExperiment(folder, "--runs 1 --only broken/points");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("no run succeeded"));
}

TEST(ExperimentCommand, ASignalEndsItAndTheNextCallGoesOn) {
  const ScratchFolder folder;
  const fs::path sequence = WriteData(folder);
  std::string list = PosterList(2000);  // seconds of work
  for (const char* camera : {"cam0", "cam1"}) {
    folder.Write("data/euroc/poster/mav0/" + std::string(camera) + "/data.csv", list);
  }
  const pid_t program = StartProgram({"experiment",
                                      "sensors",
                                      "--data",
                                      (folder / "data").string(),
                                      "--out",
                                      (folder / "out").string(),
                                      "--only",
                                      "euroc/poster/points",
                                      "--runs",
                                      "1"});
  const fs::path run = folder / "out/runs/euroc/poster/points/1";
  ASSERT_TRUE(WaitForFile(run / ".part/options.yaml"));  // written before the first frame
  ::kill(program, SIGINT);
  int status = 0;
  ::waitpid(program, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_FALSE(fs::exists(folder / "out/results.json"));
  for (const char* camera : {"cam0", "cam1"}) {
    folder.Write("data/euroc/poster/mav0/" + std::string(camera) + "/data.csv", PosterList(12));
  }
  const Outcome outcome = RunExperiment(folder, "--runs 1 --only euroc/poster/points");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder / "out/results.json"));
}

TEST(ExperimentCommand, ComputesTheSameFiguresTwice) {
  const ScratchFolder folder;
  EXPECT_THAT(RunProgram(folder, "experiment --list").out, HasSubstr("cutting-testbed"));
  EXPECT_THAT(RunProgram(folder, "experiment cutting-testbed --list").out,
              HasSubstr("share_within_0.01_of_brute_force"));
  for (const char* out : {"first", "second"}) {
    const Outcome outcome = RunProgram(
        folder, "experiment cutting-testbed --runs 1 --quiet --out " + Quoted(folder / out));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  for (const char* file : {"results.json", "table.md", "table.html", "plots/pose_error.svg"}) {
    EXPECT_EQ(Contents(folder / "first" / file), Contents(folder / "second" / file)) << file;
  }
}

TEST(ExperimentCommand, RefusesBadInputInOneLineBeforeAnyRun) {
  const ScratchFolder folder;
  WriteData(folder);
  const std::string data = " --data " + Quoted(folder / "data"),
                    out = " --out " + Quoted(folder / "out");
  const std::string file = Quoted(folder.Write("file", "text"));
  struct Case {
    std::string arguments, message;
  };
  const std::vector<Case> cases = {
      {"", "experiment: expected the name of one; plumbline experiment --list shows them"},
      {"sensor" + data + out, "no experiment 'sensor'; there are: sensors"},
      {"sensors" + data, "expected --out DIR"},
      {"sensors --data /does/not/exist" + out, "/does/not/exist: expected the folder"},
      {"sensors --only euroc" + data + " --out " + file, "cannot make the folder"},
      {"sensors" + data + out + " --set features.pionts=true", "unknown option 'features.pionts'"},
      {"sensors" + data + out + " --set slam.seed=3", "slam.seed=3 has no effect on points, lines"},
      {"sensors" + data + out + " --only nowhere", "--only nowhere: expected part of one of"},
      {"sensors" + data + out + " --runs 0", "--runs: expected a whole number from 1 to 1000"},
      {"sensors" + data + out + " --executor cloud", "--executor: expected local or slurm"},
      {"sensors" + data + out + " --sbatch x", "--sbatch: expected with --executor slurm"},
      {"sensors" + data + out + " --executor slurm --jobs 2", "--jobs: expected with --executor"},
      {"sensors" + data + out + " --memory 0", "--memory: expected a whole number from 1 to"},
      {"all --data /does/not/exist" + out, "/does/not/exist: expected the folder"},
      {"all" + data + out + " --only nowhere", "--only nowhere: expected part of one of"},
      {"all" + data, "expected --out DIR"},
      {"sensors" + data + out + " --size huge", "--size: expected test or full, found huge"},
      {"sensors" + data + out + " --job 2", "unknown option --job; the nearest is --jobs"},
      {"cutting-testbed" + out + data, "cutting-testbed: computes by itself and takes no --data"},
      {"cutting-testbed", "expected --out DIR"},
      {"cutting-testbed --out " + file, "cannot make the folder"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = RunProgram(folder, "experiment " + c.arguments + " --quiet");
    EXPECT_EQ(outcome.code, 2) << c.arguments;
    EXPECT_EQ(outcome.out, "") << c.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out")) << c.arguments;
  }
}

TEST(ExperimentCommand, ReplacesNoFileThatNoExperimentWrote) {
  const ScratchFolder folder;
  WriteData(folder);
  const std::string data = " --data " + Quoted(folder / "data");
  struct Case {
    std::string arguments, file;
  };
  const std::vector<Case> cases = {
      {"sensors --runs 1 --only poster/points" + data, "out/results.json"},
      {"sensors --runs 1 --only poster/points" + data, "out/plots/mine.svg"},
      {"cutting-testbed --runs 1", "out/table.md"},
      {"all --only poster" + data, "out/table.html"},
      {"all --only poster" + data, "out/rippl-figure8/timing.json"},
  };
  for (const Case& c : cases) {
    fs::remove_all(folder / "out");
    const fs::path file = folder.Write(c.file, "mine\n");
    const Outcome outcome = RunProgram(
        folder, "experiment " + c.arguments + " --quiet --out " + Quoted(folder / "out"));
    EXPECT_EQ(outcome.code, 2) << c.file;
    EXPECT_THAT(outcome.err, HasSubstr(file.string() + ": not written by an earlier experiment"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(Contents(file), "mine\n");
    EXPECT_FALSE(fs::exists(folder / "out/runs")) << c.file;
  }
}

}  // namespace
}  // namespace plumbline
