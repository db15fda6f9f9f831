// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kStereo = "euroc/MH_01_easy_first250";
constexpr const char* kRgbd = "tum/rgbd_dataset_freiburg1_floor_first90";

TEST(Run, WritesTheSameBytesEveryTime) {
  const std::pair<const char*, const char*> runs[] = {
      {kStereo, " --to 40"}, {kRgbd, " --to 40"}, {kRgbd, " --sensor mono --from 20 --to 60"}};
  for (const auto& [sequence, frames] : runs) {
    const auto data = FindData(sequence);
    if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    const ScratchFolder folder;
    for (const char* run : {"first", "second"}) {
      // The second time with other threads: all of it one after the other.
      const std::string threads =
          run == std::string("second") ? " --mode inline --set features.parallel=false" : "";
      const Outcome outcome = RunProgram(folder,
                                         "run " + Quoted(*data) + frames + " --quiet" + threads +
                                             " --out " + Quoted(folder / run));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    const auto names = FilesOf(folder / "first");
    EXPECT_EQ(names, FilesOf(folder / "second"));
    std::set<std::string> compared;
    for (const std::string& name : names) {
      if (!IsRepeatable(name)) continue;
      compared.insert(name);
      EXPECT_EQ(Contents(folder / "first" / name) == Contents(folder / "second" / name), true)
          << name;
    }
    EXPECT_GE(compared.size(), 6U);
    EXPECT_GT(Contents(folder / "first/trajectory.txt").size(), 1000U);
  }
}

// A copy, a link and another working directory are the same input.
TEST(Run, WritesTheSameBytesByWhateverNameTheDataGo) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  fs::create_directory_symlink(sequence, folder / "other name");
  const std::pair<fs::path, std::string> runs[] = {
      {sequence, ""}, {folder / "other name", ""}, {".", "cd " + Quoted(sequence) + " && "}};
  int number = 0;
  for (const auto& [path, before] : runs) {
    const fs::path out = folder / std::to_string(number++);
    const Outcome outcome =
        RunProgram(folder, "run " + Quoted(path) + " --quiet --out " + Quoted(out), before);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const std::string& name : FilesOf(out)) {
      if (!IsRepeatable(name)) continue;
      EXPECT_TRUE(Contents(out / name) == Contents(folder / "0" / name)) << name << " of " << path;
    }
  }
}

TEST(Run, ThePeakOfMemoryIsNotThatOfWhoeverStartedIt) {
  constexpr std::size_t kMegabytes = 512;
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 5);
  const std::vector<char> ballast(kMegabytes << 20, 1);
  const pid_t child = StartProgram({"run", sequence.string(), "--out", (folder / "run").string()});
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(WEXITSTATUS(status), 0);
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  EXPECT_GT(summary["peak_memory_mb"], 10);
  EXPECT_LT(summary["peak_memory_mb"], kMegabytes - 100) << ballast.back();
}

// How many frames it has time for is up to the machine, but each of them has its row.
TEST(Run, LiveAccountsForEveryFrame) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 30);
  const Outcome outcome = RunProgram(
      folder, "run " + Quoted(sequence) + " --mode live --quiet --out " + Quoted(folder / "run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  const auto& frames = summary["frames"];
  EXPECT_EQ(frames["in"], 30);
  EXPECT_GT(frames["tracked"], 0);
  EXPECT_EQ(frames["skipped"], frames["dropped"]);
  EXPECT_EQ(frames["dropped"], summary["shed"]["frames"]);
  std::istringstream table(Contents(folder / "run/frames.csv"));
  std::string row;
  std::getline(table, row);
  EXPECT_TRUE(row.ends_with(",shed,final_map")) << row;
  int rows = 0, dropped = 0;
  for (; std::getline(table, row); ++rows) {
    dropped += row.ends_with(",frame,");
    EXPECT_EQ(row.find(",skipped,,dropped,") != std::string::npos, row.ends_with(",frame,")) << row;
  }
  EXPECT_EQ(rows, 30);
  EXPECT_EQ(frames["dropped"], dropped);
}

// A copy of the first frames of a EuRoC folder whose files the test may break.
void CopyEuroc(const fs::path& from, const fs::path& to, std::size_t frames) {
  for (const char* camera : {"cam0", "cam1"}) {
    const fs::path source = from / "mav0" / camera;
    const fs::path target = to / "mav0" / camera;
    fs::create_directories(target / "data");
    fs::copy_file(source / "sensor.yaml", target / "sensor.yaml");
    std::istringstream list(Contents(source / "data.csv"));
    std::ofstream copy(target / "data.csv");
    std::string line;
    for (std::size_t i = 0; i < frames + 1 && std::getline(list, line); ++i) {
      copy << line << '\n';
      if (i == 0) continue;  // heading
      std::string name = line.substr(line.find(',') + 1);
      name.erase(name.find_last_not_of("\r ") + 1);
      fs::copy_file(source / "data" / name, target / "data" / name);
    }
  }
}

TEST(Run, GoesOnAfterAnUnreadableImage) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  CopyEuroc(*data, folder / "sequence", 6);
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder / "sequence/mav0/cam0/data")) {
    images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  ASSERT_EQ(images.size(), 6U);
  std::ofstream(images[2]) << "not an image";
  std::ofstream(images[3]) << "P5\n9000 9000\n255\n";
  fs::remove(images[4]);
  const Outcome outcome = RunProgram(
      folder, "run " + Quoted(folder / "sequence") + " --quiet --out " + Quoted(folder / "run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(images[2].filename().string()));
  EXPECT_THAT(outcome.err, HasSubstr(images[3].string() + ": expected an image of 752x480 pixels"));
  EXPECT_THAT(outcome.err, HasSubstr(images[4].filename().string()));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  EXPECT_EQ(summary["frames"]["in"], 6);
  EXPECT_EQ(summary["frames"]["skipped"], 3);
  EXPECT_EQ(summary["frames"]["tracked"], 3);
  EXPECT_TRUE(summary["accuracy"].is_null());  // no ground truth in the copy
  EXPECT_THAT(Contents(folder / "run/frames.csv"), HasSubstr(",skipped,,image_unreadable,"));
  EXPECT_THAT(Contents(folder / "run/frames.csv"), HasSubstr(",skipped,,image_size,"));
}

TEST(Run, TellsWhatServesInPlaceOfRemovedOptions) {
  const ScratchFolder folder;
  for (const auto& [option, instead] : {std::pair{"--checkpoint x", "--save-every SECONDS"},
                                        std::pair{"--checkpoint=x", "--save-every SECONDS"},
                                        std::pair{"--resume x", "--map FILE"},
                                        std::pair{"--reverse", "lists its images"}}) {
    const Outcome outcome =
        RunProgram(folder, std::string("run nowhere ") + option + " --out " + Quoted(folder / "o"));
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_THAT(outcome.err, HasSubstr(" is no option any more: ")) << option;
    EXPECT_THAT(outcome.err, HasSubstr(instead)) << option;
    EXPECT_FALSE(std::filesystem::exists(folder / "o")) << option;
  }
}

}  // namespace
}  // namespace plumbline
