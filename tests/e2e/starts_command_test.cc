// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Outcome RunStarts(const ScratchFolder& folder, const std::string& more, const char* out = "out") {
  return RunProgram(
      folder,
      "starts " + Quoted(folder / "sequence") + " --out " + Quoted(folder / out) + " " + more);
}

long Lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(StartsCommand, WritesTheSameStartsTwice) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  for (const char* out : {"first", "second"}) {
    const Outcome outcome = RunStarts(folder, "--every 4", out);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("3 starts, "));
    EXPECT_THAT(outcome.err, HasSubstr("3/3 starts"));
  }
  const std::string starts = Contents(folder / "first/starts.csv");
  EXPECT_EQ(starts, Contents(folder / "second/starts.csv"));
  EXPECT_EQ(Lines(starts), 4);
  const auto summary = nlohmann::json::parse(Contents(folder / "first/summary.json"));
  EXPECT_EQ(summary["starts"]["starts"], 3);
  EXPECT_EQ(summary["starts"]["possible"], 2) << "from 0 and 4, not from 8";
  EXPECT_GT(summary["add"]["median_ms"], 0);
  const Outcome one = RunStarts(folder, "--start 3", "third");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(Contents(folder / "third/starts.csv"), HasSubstr("\n3,"));
}

// The options of a start are those of a run with the preset, and --set comes after it.
TEST(StartsCommand, TakesThePresetOfAPaper) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  const Outcome outcome =
      RunStarts(folder, "--start 0 --preset rippl --set features.point_count=2000");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "out/summary.json"));
  EXPECT_EQ(summary["preset"], "rippl");
  const std::string options = summary["options"];
  const Outcome run = RunProgram(folder, "config --preset rippl --set features.point_count=2000");
  for (const char* key : {"point_count:",
                          "line_detector:",
                          "line_count:",
                          "method: rank1_pairwise",
                          "min_line_angle_deg: 5",
                          "frames: 3"}) {
    const auto line_of = [&](const std::string& text) {
      const auto at = text.find(std::string("  ") + key);
      return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
    };
    EXPECT_NE(line_of(options), "") << key;
    EXPECT_EQ(line_of(options), line_of(run.out));
  }
}

// Starts with a map.
long Maps(const std::string& starts) {
  long maps = Lines(starts) - 1;
  const std::string waiting = ",waiting,";
  for (auto at = starts.find(waiting); at != std::string::npos; at = starts.find(waiting, at + 1)) {
    --maps;
  }
  return maps;
}

TEST(StartsCommand, DrawsEveryMap) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  const Outcome outcome = RunStarts(folder, "--every 4 --draw");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  long drawings = 0;
  for (const std::string& name : FilesOf(folder / "out")) drawings += name.ends_with(".png");
  EXPECT_GT(drawings, 0);
  EXPECT_EQ(drawings, Maps(Contents(folder / "out/starts.csv")));
}

TEST(StartsCommand, JudgesByOtherPosesWhereAskedTo) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  std::string still;
  for (int i = 0; i < 12; ++i) still += fmt::format("{:.9f} 0 0 0 0 0 0 1\n", 1 + 0.05 * i);
  const Outcome outcome =
      RunStarts(folder, "--every 4 --poses " + Quoted(folder.Write("still.txt", still)));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "out/summary.json"));
  EXPECT_EQ(summary["starts"]["possible"], 0) << "without motion";
  EXPECT_GT(summary["starts"]["wrong"], 0);
  EXPECT_EQ(summary["starts"]["wrong"], Maps(Contents(folder / "out/starts.csv")));
}

TEST(StartsCommand, RefusesBadInputInOneLine) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  struct Case {
    std::string arguments, message;
  };
  const std::vector<Case> cases = {
      {"--from 11", "--from 11: expected a frame with one behind it; there are 12"},
      {"--start 11", "--start: expected a whole number from 0 to 10, found 11"},
      {"--start x", "found x"},
      {"--least-parallax -1", "--least-parallax: expected a number from 0 to 180, found -1"},
      {"--set tracking.reference=last_frame", "unknown option 'tracking.reference'"},
      {"--set initialization.method=guess", "initialization.method"},
      {"--preset ripple", "preset: expected good-line-cutting or rippl, found 'ripple'"},
      {"--preset good-line-cutting",
       "expected a preset for one camera, found one for a stereo pair"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = RunStarts(folder, c.arguments);
    EXPECT_EQ(outcome.code, 2) << c.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
    EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out")) << c.arguments;
  }
  fs::remove_all(folder / "sequence/mav0/state_groundtruth_estimate0");
  EXPECT_THAT(RunStarts(folder, "").err, HasSubstr("expected ground truth, found none"));
}

TEST(StartsCommand, WhatIsReadIsNotReplaced) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  for (const char* out : {"sequence", "sequence/out", "."}) {
    const Outcome outcome = RunStarts(folder, "--start 0", out);
    EXPECT_EQ(outcome.code, 2) << out;
    EXPECT_THAT(outcome.err, HasSubstr("which is read; choose another folder"));
  }
  EXPECT_FALSE(fs::exists(folder / "starts.csv"));
  EXPECT_EQ(FilesOf(folder / "sequence"), std::set<std::string>{"mav0"});
}

TEST(StartsCommand, ReplacesOnlyWhatItWroteItself) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  for (const char* name : {"summary.json", "starts.csv", "start_000000.png"}) {
    fs::remove_all(folder / "out");
    folder.Write(std::string("out/") + name, "mine");
    const Outcome outcome = RunStarts(folder, "--start 0");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, HasSubstr(name + std::string(": not written by an earlier call")));
    EXPECT_EQ(Contents(folder / "out" / name), "mine");
    EXPECT_EQ(FilesOf(folder / "out").size(), 1U) << name;
  }
  fs::remove_all(folder / "out");
  folder.Write("out/diary.txt", "dear");
  EXPECT_EQ(RunStarts(folder, "--start 0 --draw").code, 0);
  EXPECT_EQ(RunStarts(folder, "--start 3 --draw").code, 0);
  EXPECT_THAT(Contents(folder / "out/starts.csv"), HasSubstr("\n3,"));
  EXPECT_EQ(Contents(folder / "out/diary.txt"), "dear");
}

// What cannot be written in the end is known before the work, and nothing is replaced.
TEST(StartsCommand, ItsPlaceIsCheckedBeforeTheWork) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  ASSERT_EQ(RunStarts(folder, "--start 0").code, 0);
  const std::string starts = Contents(folder / "out/starts.csv");
  fs::remove(folder / "out/summary.json");
  fs::create_directories(folder / "out/summary.json");
  const Outcome outcome = RunStarts(folder, "--start 3");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("summary.json: Is a directory"));
  EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
  EXPECT_EQ(Contents(folder / "out/starts.csv"), starts);
}

TEST(StartsCommand, PosesOfAnotherTimeAreAnError) {
  const ScratchFolder folder;
  WritePosterSequence(folder, 12);
  const fs::path poses = folder.Write("late.txt", "100 0 0 0 0 0 0 1\n101 0 0 0 0 0 0 1\n");
  const Outcome outcome = RunStarts(folder, "--poses " + Quoted(poses));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("no frame has a pose at its time: the poses cover 100.000000000 to "
                        "101.000000000, the frames 1.000000000 to 1.550000000"));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(StartsCommand, TheExperimentMakesTablesOfThem) {
  const ScratchFolder folder;
  fs::create_directories(folder / "data/euroc");
  fs::rename(WritePosterSequence(folder, 12), folder / "data/euroc/poster");
  const std::string command = "experiment initialization --only euroc --data " +
                              Quoted(folder / "data") + " --out " + Quoted(folder / "out");
  const Outcome outcome = RunProgram(folder, command);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("5 runs; results in "));
  const std::string table = Contents(folder / "out/table.md");
  for (const char* method :
       {"rank1", "rank1_descriptors", "rank1_unweighted", "rank1_klt", "two_view"}) {
    EXPECT_THAT(table, HasSubstr("| euroc/poster | " + std::string(method) + " | 1 | 3 | "));
    EXPECT_THAT(table, HasSubstr("| real | " + std::string(method) + " | 1 | 3 | "));
  }
  EXPECT_EQ(Lines(Contents(folder / "out/starts.csv")), 16);
  EXPECT_THAT(Contents(folder / "out/table.html"), HasSubstr("possible starts with a right map"));
  const auto results = nlohmann::json::parse(Contents(folder / "out/results.json"));
  EXPECT_EQ(results[0]["metric"], "starts");
  EXPECT_EQ(results[0]["value"], 3);
  const Outcome again = RunProgram(folder, command + " --dry-run");
  EXPECT_EQ(again.out.find("run   "), std::string::npos) << again.out;
}

}  // namespace
}  // namespace plumbline
