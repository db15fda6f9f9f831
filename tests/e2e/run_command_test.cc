// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <set>
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
  fs::remove(images[4]);
  const Outcome outcome = RunProgram(
      folder, "run " + Quoted(folder / "sequence") + " --quiet --out " + Quoted(folder / "run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(images[2].filename().string()));
  EXPECT_THAT(outcome.err, HasSubstr(images[4].filename().string()));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  EXPECT_EQ(summary["frames"]["in"], 6);
  EXPECT_EQ(summary["frames"]["skipped"], 2);
  EXPECT_EQ(summary["frames"]["tracked"], 4);
  EXPECT_TRUE(summary["accuracy"].is_null());  // no ground truth in the copy
  EXPECT_THAT(Contents(folder / "run/frames.csv"), HasSubstr(",skipped,,image_unreadable,"));
}

}  // namespace
}  // namespace plumbline
