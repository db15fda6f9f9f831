// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Runs that go on in the map of an earlier run.
#include "plumbline/io/map_file/map_io.h"

#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

nlohmann::json SummaryOf(const fs::path& run) {
  return nlohmann::json::parse(Contents(run / "summary.json"));
}

// A poster sequence of 40 frames and the map of a run over it.
struct MappedPoster {
  ScratchFolder folder;
  fs::path sequence = WritePosterSequence(folder, 40);
  fs::path run = folder / "first";

  MappedPoster() {
    const Outcome outcome = Run("--out " + Quoted(run));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  fs::path map() const { return run / "map.plb"; }
  Outcome Run(const std::string& arguments) const {
    return RunProgram(folder, "run " + Quoted(sequence) + " --quiet " + arguments);
  }
};

TEST(MapUse, LocalizingChangesNothingOfTheMap) {
  const MappedPoster poster;
  const Outcome outcome = poster.Run("--from 8 --map " + Quoted(poster.map()) +
                                     " --localize --out " + Quoted(poster.folder / "where"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(Contents(poster.folder / "where/map.plb") == Contents(poster.map()));
  const auto summary = SummaryOf(poster.folder / "where");
  EXPECT_EQ(summary["frames"]["in"], 32);
  EXPECT_GE(summary["frames"]["tracked"], 29);
  EXPECT_TRUE(Contents(poster.folder / "where/keyframes.txt").empty());
  EXPECT_THAT(Contents(poster.folder / "where/frames.csv"), HasSubstr(",lost,,not_relocalized,"));
}

TEST(MapUse, GoingOnRepeatsToTheLastByteAndMayReplaceTheMap) {
  const MappedPoster poster;
  const auto go_on = [&](const std::string& out, const std::string& mode) {
    const Outcome outcome = poster.Run("--from 5 --mode " + mode + " --map " +
                                       Quoted(poster.map()) + " --out " + Quoted(out));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  go_on((poster.folder / "a").string(), "lockstep");
  go_on((poster.folder / "b").string(), "inline");
  for (const std::string& name : FilesOf(poster.folder / "a")) {
    if (!IsRepeatable(name)) continue;
    EXPECT_TRUE(Contents(poster.folder / "a" / name) == Contents(poster.folder / "b" / name))
        << name;
  }
  const SavedAtlas grown = LoadAtlas(poster.folder / "a/map.plb");
  EXPECT_EQ(grown.context.sessions.size(), 2U);
  // The map that is read may be the one that is replaced.
  go_on(poster.run.string(), "lockstep");
  EXPECT_TRUE(Contents(poster.map()) == Contents(poster.folder / "a/map.plb"));
}

TEST(MapUse, RefusesWhatIsNoMapOfThisCameraAndTouchesNothing) {
  const MappedPoster poster;
  const std::string map = Contents(poster.map());
  poster.folder.Write("cut.plb", map.substr(0, map.size() / 2));
  std::string damaged = map;
  damaged[map.size() / 3] ^= 1;
  poster.folder.Write("damaged.plb", damaged);
  SavedAtlas other = LoadAtlas(poster.map());
  other.context.camera.fx *= 1.1;
  SaveAtlas(poster.folder / "other.plb", other.atlas, other.context);
  const std::string out = " --out " + Quoted(poster.folder / "out");
  const auto expect_refused = [&](const std::string& arguments, const std::string& why) {
    const Outcome outcome = poster.Run(arguments + out);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(poster.folder / "out")) << arguments;
  };
  expect_refused("--map " + Quoted(poster.folder / "none.plb"), "none.plb: no such file");
  expect_refused("--map " + Quoted(poster.folder / "cut.plb"), "cut.plb: ");
  expect_refused("--map " + Quoted(poster.folder / "damaged.plb"), "damaged.plb: ");
  expect_refused("--map " + Quoted(poster.folder / "other.plb"), "other.plb: expected a map of");
  expect_refused("--localize", "--localize: expected --map FILE");
  expect_refused("--save-every 0", "--save-every: expected");
  expect_refused("--sensor mono --map " + Quoted(poster.map()),
                 "map.plb: expected a map made with one camera, as the images are now, found one "
                 "made with a stereo pair or depth; go on in it with the same sensor");
  expect_refused("--set relocalization.enabled=false --map " + Quoted(poster.map()),
                 "relocalization.enabled");
}

TEST(MapUse, TellsOfOtherOptionsUnlessItIsToBeQuiet) {
  const MappedPoster poster;
  const std::string arguments = "run " + Quoted(poster.sequence) + " --to 4 --map " +
                                Quoted(poster.map()) + " --set features.point_count=900 --out " +
                                Quoted(poster.folder / "out");
  EXPECT_THAT(RunProgram(poster.folder, arguments).err,
              HasSubstr("the map was made with another front end: "));
  const Outcome quiet = RunProgram(poster.folder, arguments + " --quiet");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.err + quiet.out, "");
}

TEST(MapUse, SavingWhileRunningChangesNoResult) {
  const MappedPoster poster;
  ASSERT_EQ(poster.Run("--save-every 1 --out " + Quoted(poster.folder / "saved")).code, 0);
  EXPECT_TRUE(Contents(poster.folder / "saved/map.plb") == Contents(poster.map()));
  EXPECT_TRUE(Contents(poster.folder / "saved/trajectory.txt") ==
              Contents(poster.run / "trajectory.txt"));
}

TEST(MapUse, WhatWasSavedWhileRunningSurvivesTheRun) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 5000);
  const pid_t program = StartProgram(
      {"run", sequence.string(), "--save-every", "1", "--out", (folder / "out").string()});
  ASSERT_TRUE(WaitForFile(folder / "out/.part/map.plb"));
  ::kill(program, SIGKILL);
  int status = 0;
  ::waitpid(program, &status, 0);
  const SavedAtlas saved = LoadAtlas(folder / "out/.part/map.plb");
  ASSERT_FALSE(saved.atlas.empty());
  saved.atlas.active().CheckInvariants();
  EXPECT_EQ(saved.context.sessions.size(), 1U);
}

TEST(MapUse, MachineHallIsLocalizedInItsOwnMap) {
  const auto data = FindData("euroc/MH_01_easy_first250");
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  ASSERT_EQ(
      RunProgram(folder, "run " + Quoted(*data) + " --quiet --out " + Quoted(folder / "map")).code,
      0);
  const fs::path map = folder / "map/map.plb";
  const Outcome outcome =
      RunProgram(folder,
                 "run " + Quoted(*data) + " --quiet --from 100 --localize --map " + Quoted(map) +
                     " --out " + Quoted(folder / "where"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = SummaryOf(folder / "where");
  EXPECT_EQ(summary["frames"]["in"], 150);
  EXPECT_GE(summary["frames"]["tracked"], 140);
  EXPECT_LE(summary["accuracy"]["ate"]["rmse"], 0.006);
  EXPECT_TRUE(Contents(folder / "where/map.plb") == Contents(map));
}

}  // namespace
}  // namespace plumbline
