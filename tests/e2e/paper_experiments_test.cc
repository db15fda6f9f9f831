// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace paper_experiments_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// A sequence of 12 frames under the name of one of EuRoC's, in its native layout.
void WriteEuroc(const ScratchFolder& folder, const std::string& name) {
  fs::create_directories(folder / "data/euroc");
  fs::rename(WritePosterSequence(folder, 12), folder / ("data/euroc/" + name));
}

// The same images, in the middle of larger ones, in the native layout of the TUM RGB-D benchmark.
void WriteTum(const ScratchFolder& folder, const std::string& name) {
  const std::string root = "data/tum/" + name;
  std::string list = "# color images\n", truth = "# ground truth trajectory\n";
  const MovingPoster poster;
  for (int i = 0; i < 12; ++i) {
    GrayImage image(640, 480, 128);
    const GrayImage part = poster.Frame(i).left;
    for (int y = 0; y < part.height(); ++y) {
      for (int x = 0; x < part.width(); ++x) image.at(x + 120, y + 90) = part.at(x, y);
    }
    const double stamp = 1305031102.1753 + i / 30.0;
    const std::string file = fmt::format("rgb/{:.6f}.png", stamp);
    WriteGrayPng(folder.Write(root + "/" + file, ""), image);
    list += fmt::format("{:.6f} {}\n", stamp, file);
    truth += fmt::format("{:.4f} {} 0 0 0 0 0 1\n", stamp, 0.03 * i);
  }
  folder.Write(root + "/rgb.txt", list);
  folder.Write(root + "/groundtruth.txt", truth);
}

Outcome RunExperiment(const ScratchFolder& folder, const std::string& arguments) {
  return RunProgram(folder,
                    "experiment " + arguments + " --data " + Quoted(folder / "data") + " --out " +
                        Quoted(folder / "out"));
}

nlohmann::json Results(const ScratchFolder& folder, const std::string& part = "") {
  return nlohmann::json::parse(Contents(folder / ("out/" + part + "results.json")));
}

TEST(PaperExperiments, FindTheirSequencesAndSayWhereTheOthersAre) {
  const ScratchFolder folder;
  WriteTum(folder, "rgbd_dataset_freiburg1_xyz");
  WriteTum(folder, "rgbd_dataset_freiburg1_floor_first12");
  const Outcome outcome = RunExperiment(folder, "rippl-table1 --only tum/ --runs 1");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("tum/rgbd_dataset_freiburg2_desk (fr2_desk; https://"));
  std::set<std::string> sequences;
  for (const auto& row : Results(folder)) sequences.insert(row["sequence"]);
  EXPECT_EQ(sequences,
            (std::set<std::string>{"tum/rgbd_dataset_freiburg1_floor_first12",
                                   "tum/rgbd_dataset_freiburg1_xyz"}));
  const std::string table = Contents(folder / "out/table.md");
  EXPECT_THAT(table, HasSubstr("| fr1_xyz | 10.178 | "));
  EXPECT_THAT(table, HasSubstr("| fr2_desk | 46.464 | - | 46.942 | - | not there: `experiment "));
  EXPECT_THAT(table, HasSubstr("fr1_floor (a part: tum/rgbd_dataset_freiburg1_floor_first12)"));
  EXPECT_THAT(Contents(folder / "out/table.html"), HasSubstr("Beside the paper"));
}

TEST(PaperExperiments, BlurredSequencesAreRunsOfTheirOwn) {
  const ScratchFolder folder;
  WriteEuroc(folder, "V1_01_easy");
  const Outcome outcome =
      RunExperiment(folder, "cutting-table2-3 --only '*V1_01_easy*/PL' --runs 1 --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto blurred = nlohmann::json::parse(
      Contents(folder / "out/runs/euroc/V1_01_easy@blurred/PL/1/summary.json"));
  EXPECT_EQ(blurred["frames"]["in"], 12);
  const std::string table = Contents(folder / "out/table.md");
  EXPECT_THAT(table, HasSubstr("| euroc/V1_01_easy@blurred | PL | 1 |"));
  EXPECT_THAT(table, HasSubstr("| V1_01_easy blurred | 0.054 |"));
}

TEST(PaperExperiments, CutLinesAreDrawnOnTheImage) {
  const ScratchFolder folder;
  WriteEuroc(folder, "V1_03_difficult");
  const Outcome outcome = RunExperiment(folder, "cutting-figure5 --only euroc/ --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string svg = Contents(folder / "out/plots/cut_lines_euroc_V1_03_difficult_PL+Cut.svg");
  EXPECT_THAT(svg, HasSubstr("width=\"400\" height=\"300\""));
  EXPECT_GT(svg.size(), 10'000U) << "the image is in it";
}

TEST(PaperExperiments, AGroupGoesOnWherePartsOfItCannot) {
  const ScratchFolder folder;
  WriteEuroc(folder, "V1_01_easy");
  const Outcome dry = RunExperiment(folder, "all --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  for (const char* run : {"cutting-figure2-4", "worlds/lowtexture/PL+Cut/1", "euroc/V1_01_easy"}) {
    EXPECT_THAT(dry.out, HasSubstr(run));
  }
  EXPECT_THAT(dry.out, HasSubstr("0 done; the others take about "));
  EXPECT_FALSE(fs::exists(folder / "out"));
  // Two parts of the group have such a sequence and variant; --set is unknown to neither.
  folder.Write("data/euroc/V1_01_easy/mav0/cam0/data/3.png", "not an image");
  const std::string only = "all --only 'euroc/V1_01_easy/PL' --only 'euroc/V1_01_easy/PL+Cut'";
  const Outcome outcome = RunExperiment(folder, only);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::set<std::string> experiments;
  for (const auto& row : Results(folder)) experiments.insert(row["experiment"]);
  // One measures times alone, so it has no row here.
  EXPECT_EQ(experiments, (std::set<std::string>{"cutting-table2-3"}));
  EXPECT_EQ(Results(folder), Results(folder, "cutting-table2-3/"));
  EXPECT_TRUE(fs::exists(folder / "out/cutting-timing-system/timing.json"));
  EXPECT_THAT(Contents(folder / "out/table.html"), HasSubstr("cutting-table2-3/table.html"));
  // Nothing is run twice.
  const Outcome again = RunExperiment(folder, only + " --dry-run");
  EXPECT_THAT(again.out, Not(HasSubstr("run   ")));
}

TEST(PaperExperiments, AnEmptyDataFolderLeavesTheWorlds) {
  const ScratchFolder folder;
  fs::create_directories(folder / "data");
  const Outcome dry = RunExperiment(folder, "cutting-table1 --dry-run");
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("worlds/lowtexture/L/1"));
  EXPECT_EQ(dry.err, "") << "no recording is asked for";
  const Outcome none = RunExperiment(folder, "robustness");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("robustness: no sequence found for euroc/*"));
}

TEST(ExperimentGate, ABrokenLimitIsAnExitCode) {
  const ScratchFolder folder;
  WriteEuroc(folder, "MH_01_easy_first250");
  const Outcome kept = RunExperiment(folder, "gate --only euroc/*/both");
  EXPECT_EQ(kept.code, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr("| kept | euroc/MH_01_easy_first250 | both | ate [mm] |"));
  folder.Write("data/euroc/MH_01_easy_first250/mav0/cam0/data.csv", "now,1.png\n");
  const Outcome broken = RunExperiment(folder, "gate --only euroc/*/both");
  EXPECT_EQ(broken.code, 1) << broken.err;
  EXPECT_THAT(broken.err, HasSubstr("limits are broken"));
  EXPECT_THAT(Contents(folder / "out/gate.md"), HasSubstr("**broken**"));
}

}  // namespace paper_experiments_test
}  // namespace plumbline
