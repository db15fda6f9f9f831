// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

std::string RunArguments(const fs::path& sequence, const fs::path& out, const std::string& more) {
  return "run " + Quoted(sequence) + " --quiet --out " + Quoted(out) + " " + more;
}

// Every file in `folder` is one of a complete run, with the same contents where those repeat.
void ExpectWholeFiles(const fs::path& folder, const fs::path& complete) {
  for (const std::string& name : FilesOf(folder)) {
    EXPECT_TRUE(fs::exists(complete / name)) << name;
    if (IsRepeatable(name) || name == "options.yaml" || name.starts_with("overlay")) {
      EXPECT_TRUE(Contents(folder / name) == Contents(complete / name)) << name;
    }
  }
}

TEST(RunFolder, HoldsTheFilesOfOneRun) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "fresh", "--to 4")).code, 0);
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "again", "--to 12")).code, 0);
  for (const char* old : {"trajectory_map3.txt",
                          "trajectory_causal_map3.txt",
                          "keyframes_map3.txt",
                          "overlay_000099.png",
                          ".trajectory.4711.tmp.txt",
                          ".overlay_000002.4711.tmp.png"}) {
    folder.Write(std::string("again/") + old, "old");
  }
  for (const char* kept : {"notes.txt", ".hidden.txt", "map.jpg", "my_trajectory.txt"}) {
    folder.Write(std::string("again/") + kept, "not of a run");
  }
  const Outcome outcome = RunProgram(folder, RunArguments(sequence, folder / "again", "--to 4"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto expected = FilesOf(folder / "fresh");
  expected.insert({"notes.txt", ".hidden.txt", "map.jpg", "my_trajectory.txt"});
  EXPECT_EQ(FilesOf(folder / "again"), expected);
}

// A limit on the size of files takes the part of a disk that is full.
TEST(RunFolder, AFileThatDoesNotFitIsNamedAndLeavesNothing) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "whole", "")).code, 0);
  for (const char* name : {"options.yaml", "overlay_000000.png", "map.plb"}) {
    const auto blocks = (fs::file_size(folder / "whole" / name) - 1) / 512;
    const Outcome outcome = RunProgram(folder,
                                       RunArguments(sequence, folder / "out", ""),
                                       fmt::format("trap '' XFSZ; ulimit -f {}; ", blocks));
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err,
                StartsWith("plumbline: cannot write " + (folder / "out").string() + "/"));
    EXPECT_THAT(outcome.err, HasSubstr(": File too large\n"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    ExpectWholeFiles(folder / "out", folder / "whole");
    EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
  }
}

TEST(RunFolder, AFullDiskIsNamedAndLeavesNothing) {
  const ScratchFolder folder;
  const fs::path disk = folder / "disk";
  fs::create_directories(disk);
  const fs::path sequence = WritePosterSequence(folder, 12);
  const std::string mount = "mount -t tmpfs -o size=256k none " + Quoted(disk);
  const std::string alone = "unshare --user --map-root-user --mount sh -c ";
  const std::string probe = alone + "\"" + mount + "\" > /dev/null 2>&1";
  if (std::system(probe.c_str()) != 0) {  // NOLINT(concurrency-mt-unsafe)
    GTEST_SKIP() << "a small file system cannot be mounted here";
  }
  const fs::path script =
      folder.Write("script",
                   mount + "\n'" PLUMBLINE_BINARY "' " + RunArguments(sequence, disk / "out", "") +
                       " 2> " + Quoted(folder / "err") + "\ncode=$?\ncp -r " +
                       Quoted(disk / "out") + " " + Quoted(folder / "kept") + "\nexit $code\n");
  const std::string command =
      "unshare --user --map-root-user --mount sh " + Quoted(script) + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const std::string err = Contents(folder / "err");
  EXPECT_THAT(err, StartsWith("plumbline: cannot write " + (disk / "out").string() + "/"));
  EXPECT_THAT(err, HasSubstr(": No space left on device\n"));
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "whole", "")).code, 0);
  ExpectWholeFiles(folder / "kept", folder / "whole");
}

TEST(RunFolder, StandardOutputThatIsFullIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const ScratchFolder folder;
  const std::string command =
      "'" PLUMBLINE_BINARY "' config > /dev/full 2> " + Quoted(folder / "err");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(Contents(folder / "err"), "plumbline: cannot write to standard output\n");
}

TEST(RunFolder, ARunThatIsAskedToStopWritesEverything) {
  for (const auto& [signal, mode] :
       {std::pair(SIGTERM, "inline"), std::pair(SIGINT, "lockstep"), std::pair(SIGTERM, "live")}) {
    const ScratchFolder folder;
    const fs::path out = folder / "run";
    const fs::path sequence = WritePosterSequence(folder, 4000);
    const pid_t child =
        StartProgram({"run", sequence.string(), "--mode", mode, "--quiet", "--out", out.string()});
    // The options are written just before the first frame.
    EXPECT_TRUE(WaitForFile(out / "options.yaml"));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    ASSERT_EQ(::kill(child, signal), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    const auto summary = nlohmann::json::parse(Contents(out / "summary.json"));
    const int frames = summary["frames"]["in"];
    EXPECT_GT(frames, 0);
    EXPECT_LT(frames, 4000);
    const std::string table = Contents(out / "frames.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), frames + 1);
    const std::string poses = Contents(out / "trajectory.txt");
    EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), summary["frames"]["tracked"]);
    for (const char* name :
         {"trajectory_causal.txt", "keyframes.txt", "timing.json", "map.plb", "report.html"}) {
      EXPECT_TRUE(fs::exists(out / name)) << name;
    }
    for (const std::string& name : FilesOf(out)) EXPECT_NE(name.front(), '.') << name;
  }
}

TEST(RunFolder, HoldsWhatWasDoneBeforeAnImageOfAnotherSize) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  WriteGrayPng(sequence / "mav0/cam1/data/7.png", GrayImage(40, 30, 90));
  for (const char* mode : {"inline", "lockstep"}) {
    const fs::path out = folder / mode;
    const Outcome outcome =
        RunProgram(folder, RunArguments(sequence, out, std::string(" --mode ") + mode));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, testing::HasSubstr("400x300"));
    EXPECT_THAT(outcome.err, testing::HasSubstr("40x30"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    const std::string poses = Contents(out / "trajectory.txt");
    EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 7);
    EXPECT_EQ(nlohmann::json::parse(Contents(out / "summary.json"))["frames"]["in"], 7);
  }
}

// Killed once while frames are processed, once while results are written.
TEST(RunFolder, ARunThatIsKilledLeavesWholeFilesAndAFolderToUseAgain) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "whole", "")).code, 0);
  const fs::path out = folder / "run";
  for (const char* until : {"options.yaml", "trajectory.txt", "map.ply"}) {
    const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
    EXPECT_TRUE(WaitForFile(out / until));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    for (const auto& name : FilesOf(out)) {
      if (name.starts_with('.')) fs::rename(out / name, folder / "temporary");
    }
    ExpectWholeFiles(out, folder / "whole");
    if (fs::exists(folder / "temporary")) {
      fs::rename(folder / "temporary", out / ".map.4711.tmp.plb");
    }
    const Outcome again = RunProgram(folder, RunArguments(sequence, out, ""));
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(FilesOf(out), FilesOf(folder / "whole"));
    ExpectWholeFiles(out, folder / "whole");
    fs::remove_all(out);
  }
}

}  // namespace
}  // namespace plumbline
