// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace run_folder_test {

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
  for (const char* kept : {"notes.txt", ".hidden.txt", "map.jpg", "my_trajectory.txt"}) {
    folder.Write(std::string("again/") + kept, "not of a run");
  }
  const Outcome outcome = RunProgram(folder, RunArguments(sequence, folder / "again", "--to 4"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto expected = FilesOf(folder / "fresh");
  expected.insert({"notes.txt", ".hidden.txt", "map.jpg", "my_trajectory.txt"});
  EXPECT_EQ(FilesOf(folder / "again"), expected);
}

void ExpectRefused(const Outcome& outcome, const std::string& why) {
  EXPECT_EQ(outcome.code, 2) << why;
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, StartsWith("plumbline: "));
  EXPECT_THAT(outcome.err, HasSubstr(why));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST(RunFolder, FilesOfTheUserAreNotReplaced) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 3);
  for (const char* name :
       {"trajectory.txt", "report.html", "options.yaml", "keyframes.txt", "overlay_000000.png"}) {
    const fs::path mine = folder.Write(std::string("out/") + name, "mine");
    ExpectRefused(RunProgram(folder, RunArguments(sequence, folder / "out", "")),
                  mine.string() + ": not written by an earlier run");
    EXPECT_EQ(FilesOf(folder / "out"), std::set<std::string>{name});
    EXPECT_EQ(Contents(mine), "mine");
    fs::remove_all(folder / "out");
  }
}

// Pictures as runs draw them, with a camera: a sequence like any other.
TEST(RunFolder, WhatIsReadIsNotReplaced) {
  const ScratchFolder folder;
  const MovingPoster poster;
  for (int i = 0; i < 4; ++i) {
    folder.Write(fmt::format("images/overlay_{:06}.png", i), "");
    WriteGrayPng(folder / fmt::format("images/overlay_{:06}.png", i), poster.Frame(i).left);
  }
  const fs::path camera =
      folder.Write("images/camera.yaml",
                   fmt::format("model: pinhole\nsize: [{}, {}]\nintrinsics: [{}, {}, {}, {}]\n"
                               "distortion: none\nrate_hz: 20\n",
                               MovingPoster::kWidth,
                               MovingPoster::kHeight,
                               MovingPoster::kFocal,
                               MovingPoster::kFocal,
                               MovingPoster::kWidth / 2.0,
                               MovingPoster::kHeight / 2.0));
  const fs::path config = folder.Write("settings/own.yaml", "slam:\n  seed: 3\n");
  const fs::path images = folder / "images";
  const auto before = FilesOf(images);
  const fs::path link = folder / "link";
  fs::create_directory_symlink(images, link);
  for (const fs::path& out : {images, images / "", images / "new", link, folder.path()}) {
    ExpectRefused(RunProgram(folder, RunArguments(images, out, "")), "which is read");
    EXPECT_EQ(FilesOf(images), before);
  }
  ExpectRefused(
      RunProgram(folder, RunArguments(images, folder / "settings", "--config " + Quoted(config))),
      "holds " + config.string());
  // Into another folder it goes, again and again, and is not read the second time. Four frames give
  // one camera no map.
  for (const char* frames : {"first", "second"}) {
    const Outcome outcome = RunProgram(folder, RunArguments(images, folder / "out", ""));
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(Contents(folder / "out/summary.json"))["frames"]["in"], 4)
        << frames;
  }
}

TEST(RunFolder, ARunThatFailsAtOnceLeavesTheEarlierResults) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  const fs::path out = folder / "out";
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, out, "")).code, 0);
  fs::copy(out, folder / "copy", fs::copy_options::recursive);
  const fs::path camera = folder.Write("none.yaml", "model: pinhole\n");
  for (const std::string& more : {"--camera " + Quoted(camera),
                                  std::string("--set tracking.reference=none"),
                                  std::string("--from 100"),
                                  std::string("--sensor mono --set tracking.reference=last_frame"),
                                  std::string("--format kitti")}) {
    EXPECT_EQ(RunProgram(folder, RunArguments(sequence, out, more)).code, 2) << more;
    EXPECT_EQ(FilesOf(out), FilesOf(folder / "copy")) << more;
    for (const std::string& name : FilesOf(out)) {
      EXPECT_TRUE(Contents(out / name) == Contents(folder / "copy" / name)) << name << more;
    }
  }
}

// A limit on the size of files takes the part of a disk that is full.
TEST(RunFolder, AFileThatDoesNotFitIsNamedAndTheOthersAreWritten) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const fs::path whole = folder / "whole";
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, whole, "")).code, 0);
  for (const char* name : {"overlay_000000.png", "map.plb", "options.yaml"}) {
    const fs::path out = folder / (std::string("out of ") + name);
    const auto blocks = (fs::file_size(whole / name) - 1) / 512;
    const Outcome outcome =
        RunProgram(folder, RunArguments(sequence, out, ""), fmt::format("ulimit -f {}; ", blocks));
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, StartsWith("plumbline: cannot write " + out.string() + "/"));
    EXPECT_THAT(outcome.err, HasSubstr(name));
    EXPECT_THAT(outcome.err, HasSubstr(": File too large\n"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    if (name == std::string("options.yaml")) {
      EXPECT_FALSE(fs::exists(out)) << "before anything was done";
      continue;
    }
    ExpectWholeFiles(out, whole);
    for (const std::string& other : FilesOf(whole)) {
      if (fs::file_size(whole / other) > 512 * blocks * 9 / 10) continue;
      EXPECT_TRUE(fs::exists(out / other)) << other << " beside " << name;
    }
    EXPECT_TRUE(fs::exists(out / "trajectory.txt"));
  }
}

TEST(RunFolder, LessDoesNotReplaceMore) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const fs::path out = folder / "out";
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, out, "")).code, 0);
  fs::copy(out, folder / "copy", fs::copy_options::recursive);
  const auto blocks = (fs::file_size(out / "map.plb") - 1) / 512;
  Outcome outcome = RunProgram(
      folder, RunArguments(sequence, out, "--to 11"), fmt::format("ulimit -f {}; ", blocks));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("map.plb"));
  EXPECT_THAT(outcome.err, HasSubstr(out.string() + " keeps the earlier results"));
  for (const std::string& name : FilesOf(folder / "copy")) {
    EXPECT_TRUE(Contents(out / name) == Contents(folder / "copy" / name)) << name;
  }
  const std::string poses = Contents(out / ".part/trajectory.txt");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 11);
  outcome = RunProgram(folder, RunArguments(sequence, out, "--to 10"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted-1"));
  EXPECT_TRUE(Contents(out / "interrupted-1/trajectory.txt") == poses);
}

TEST(RunFolder, AFullDiskIsNamedAndCostsWhatIsWorthLeast) {
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
  for (const char* name :
       {"trajectory.txt", "trajectory_causal.txt", "keyframes.txt", "frames.csv", "options.yaml"}) {
    EXPECT_TRUE(fs::exists(folder / "kept" / name)) << name;
  }
}

TEST(RunFolder, StandardOutputThatIsFullIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const ScratchFolder folder;
  const std::string command =
      "'" PLUMBLINE_BINARY "' config > /dev/full 2> " + Quoted(folder / "err");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(Contents(folder / "err"), "plumbline: cannot write to standard output\n");
}

// The first file that is opened would take the place of a stream that is closed.
TEST(RunFolder, StreamsThatAreClosedGoNowhere) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 3);
  const std::string command = "'" PLUMBLINE_BINARY "' run " + Quoted(sequence) + " --out " +
                              Quoted(folder / "out") + " <&- >&- 2>&-";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);  // NOLINT(concurrency-mt-unsafe)
  const Outcome other =
      RunProgram(folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / "other"));
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_EQ(FilesOf(folder / "out"), FilesOf(folder / "other"));
  for (const std::string& name : FilesOf(folder / "out")) {
    EXPECT_EQ(Contents(folder / "out" / name).find("results in "), std::string::npos) << name;
  }
}

// A limit on the size of files takes the part of a disk that is full.
TEST(RunFolder, ARecordingThatDoesNotFitIsAnErrorWithAllResults) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 30);
  const fs::path record = folder / "run.mcap";
  const Outcome outcome =
      RunProgram(folder,
                 RunArguments(sequence, folder / "out", "--record " + Quoted(record)),
                 "ulimit -f 2000; ");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cannot write " + record.string() + ": File too large"));
  EXPECT_FALSE(fs::exists(record));
  EXPECT_EQ(nlohmann::json::parse(Contents(folder / "out/summary.json"))["frames"]["in"], 30);
}

TEST(RunFolder, AWholeRunReplacesALongerOne) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const fs::path out = folder / "out";
  for (const int frames : {10, 5, 12}) {
    ASSERT_EQ(
        RunProgram(folder, RunArguments(sequence, out, "--to " + std::to_string(frames))).code, 0);
    const std::string poses = Contents(out / "trajectory.txt");
    EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), frames);
  }
}

// A run that is stopped early keeps the longer results of an earlier one of the same data.
TEST(RunFolder, ASignalNeverCostsPosesOfAnEarlierRun) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 400);
  const fs::path out = folder / "out";
  const auto poses = [&] {
    const std::string text = Contents(out / "trajectory.txt");
    return std::count(text.begin(), text.end(), '\n');
  };
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, out, "--to 40")).code, 0);
  ASSERT_EQ(poses(), 40);
  for (const int milliseconds : {100, 200, 300, 400}) {
    const auto before = poses();
    const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
    EXPECT_TRUE(WaitForFile(out / ".part/frames.csv"));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_GE(poses(), before) << milliseconds;
  }
}

// Ways to be removed and to be used by two at once.
TEST(RunFolder, IsMadeAgainWhenItIsRemovedDuringTheRun) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 400);
  const fs::path out = folder / "out";
  const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
  EXPECT_TRUE(WaitForFile(out / ".part/trajectory_causal.txt"));
  const Outcome second = RunProgram(folder, RunArguments(sequence, out, "--to 3"));
  ExpectRefused(second, "another run is writing into this folder");
  fs::remove_all(out);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const std::string poses = Contents(out / "trajectory.txt");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 400);
  EXPECT_TRUE(fs::exists(out / "report.html"));
  EXPECT_TRUE(fs::exists(out / "options.yaml"));
}

}  // namespace run_folder_test
}  // namespace plumbline
