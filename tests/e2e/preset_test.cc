// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <filesystem>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using nlohmann::json;

// What the preset of a paper's system must reach on a recorded sequence: errors as measured when it
// came, times 1.3.
struct PresetGate {
  const char* sequence;  // below the data folder
  const char* arguments;
  int tracked;
  double max_error;  // rippl: ATE, metres, with a free scale; good-line-cutting: causal RPE, m/s
};

constexpr PresetGate kRippl[] = {
    {"euroc/MH_01_easy_first250", "--preset rippl", 250, 0.0055},
    {"tum/rgbd_dataset_freiburg1_floor_first90", "--preset rippl", 90, 0.0039},
    {"icl/office_kt3_first600", "--preset rippl --camera icl_nuim --to 200", 200, 0.0043},
    {"kitti/06_first51", "--preset rippl", 51, 0.073},
    {"kitti/07_first160_half", "--preset rippl", 160, 0.4},
    {"kitti/00_first200", "--preset rippl", 200, 1.6}};

constexpr PresetGate kCutting[] = {
    {"euroc/MH_01_easy_first250", "--preset good-line-cutting", 249, 0.0026},
    {"kitti/06_first51", "--preset good-line-cutting", 51, 0.14}};

json RunGate(const PresetGate& gate, const ScratchFolder& folder) {
  const auto data = FindData(gate.sequence);
  if (!data) return nullptr;
  const Outcome outcome = RunProgram(
      folder,
      "run " + Quoted(*data) + " " + gate.arguments + " --quiet --out " + Quoted(folder / "run"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  if (outcome.code != 0) return nullptr;
  return json::parse(Contents(folder / "run/summary.json"));
}

// The paper's own start, and nothing of the default one.
void ExpectStagesOfRippl(const json& stages) {
  EXPECT_GT(stages["start_pairwise_poses"], 0);
  EXPECT_GT(stages["start_pairwise_factorizations"], 0);
  for (const char* other : {"start_model_selections",
                            "start_aligned_images",
                            "start_two_view_solutions",
                            "cut_lines"}) {
    EXPECT_EQ(stages[other], 0) << other;
  }
  EXPECT_GT(stages["map_adjust"], 1);
}

// One pair of images starts the map; nothing is mapped afterwards.
void ExpectStagesOfCutting(const json& stages) {
  EXPECT_GT(stages["cut_lines"], 100);
  EXPECT_LE(stages["map_adjust"], 1);
  EXPECT_FALSE(stages.contains("start_pairwise_poses"));
}

TEST(Preset, RipplReachesWhatItReached) {
  for (const PresetGate& gate : kRippl) {
    const ScratchFolder folder;
    const json summary = RunGate(gate, folder);
    if (summary.is_null()) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    SCOPED_TRACE(gate.sequence);
    EXPECT_EQ(summary["sensor"], "mono");
    EXPECT_EQ(summary["preset"], "rippl");
    EXPECT_EQ(summary["frames"]["tracked"], gate.tracked);
    EXPECT_EQ(summary["maps"], 1);
    EXPECT_LE(summary["accuracy"]["ate"]["rmse"], gate.max_error);
    ExpectStagesOfRippl(summary["stages"]);
  }
}

TEST(Preset, GoodLineCuttingReachesWhatItReached) {
  for (const PresetGate& gate : kCutting) {
    const ScratchFolder folder;
    const json summary = RunGate(gate, folder);
    if (summary.is_null()) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    SCOPED_TRACE(gate.sequence);
    EXPECT_EQ(summary["sensor"], "stereo");
    EXPECT_EQ(summary["frames"]["tracked"], gate.tracked);
    EXPECT_LE(summary["accuracy_causal"]["rpe"]["mean"], gate.max_error);
    ExpectStagesOfCutting(summary["stages"]);
  }
}

TEST(Preset, RepeatsItself) {
  for (const char* preset : {"rippl", "good-line-cutting"}) {
    const auto data = FindData("euroc/MH_01_easy_first250");
    if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    std::optional<std::string> before;
    for (const char* mode : {"inline", "lockstep"}) {
      const ScratchFolder folder;
      const Outcome outcome =
          RunProgram(folder,
                     "run " + Quoted(*data) + " --preset " + preset + " --to 30 --mode " + mode +
                         " --quiet --out " + Quoted(folder / "run"));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::string now = Contents(folder / "run/trajectory.txt");
      EXPECT_FALSE(now.empty());
      EXPECT_EQ(before.value_or(now), now) << preset;
      before = now;
    }
  }
}

// Before anything is written.
TEST(Preset, SaysWhichSensorItNeeds) {
  const auto data = FindData("tum/rgbd_dataset_freiburg1_floor_first90");
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  const Outcome outcome = RunProgram(
      folder,
      "run " + Quoted(*data) + " --preset good-line-cutting --out " + Quoted(folder / "run"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::StartsWith("plumbline: --preset good-line-cutting: "));
  EXPECT_THAT(outcome.err,
              testing::HasSubstr("expected data for stereo, found data for rgbd, mono only\n"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  const Outcome other = RunProgram(
      folder,
      "run " + Quoted(*data) + " --preset rippl --sensor stereo --out " + Quoted(folder / "run"));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err,
              testing::HasSubstr("--preset rippl: expected --sensor mono, found stereo"));
  const Outcome one = RunProgram(
      folder, "run " + Quoted(*data) + " --preset rippl --to 2 --out " + Quoted(folder / "run"));
  EXPECT_THAT(
      one.err,
      testing::HasSubstr("plumbline: --preset rippl is for one camera: depth is not used\n"));
}

}  // namespace
}  // namespace plumbline
