// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/pair_figures.h"

#include "lab/line_maps/run_trajectory.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Three frames a metre apart, with truth; the run has the one in the middle `off` metres beside.
void WriteRun(const ScratchFolder& folder, double off, const std::string& sensor) {
  WriteSequenceFolder(folder, "data/euroc/a");
  std::string truth = "#timestamp,px,py,pz,qw,qx,qy,qz\n", run;
  for (int i = 0; i < 3; ++i) {
    truth += fmt::format("{},{},0,0,1,0,0,0\n", 1'000'000'000 + 50'000'000LL * i, i);
    run += fmt::format("{:.9f} {} {} 0 0 0 0 1\n", 1 + 0.05 * i, i, i == 1 ? off : 0.0);
  }
  folder.Write("data/euroc/a/mav0/state_groundtruth_estimate0/data.csv", truth);
  folder.Write("run/trajectory.txt", run);
  folder.Write("run/summary.json", "{\"sensor\": \"" + sensor + "\"}");
}

TEST(PairFigures, AreTheErrorOfAllPairsOfFrames) {
  const ScratchFolder folder;
  WriteRun(folder, 0.03, "stereo");
  RunFigures figures;
  figures.reasons["rpe_pairs"] = "not yet";
  AddPairFigures(folder / "data/euroc/a", folder / "run", figures);
  // Of three pairs two are off by 3 cm; the alignment turns nothing of that away.
  EXPECT_NEAR(figures.values.at("rpe_pairs"), 30 * std::sqrt(2.0 / 3), 1e-3);
  EXPECT_FALSE(figures.reasons.contains("rpe_pairs"));
}

TEST(PairFigures, TellWhyThereAreNone) {
  const ScratchFolder folder;
  WriteRun(folder, 0, "stereo");
  RunFigures figures;
  folder.Write("run/trajectory.txt", "no pose\n");
  AddPairFigures(folder / "data/euroc/a", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("rpe_pairs"), "the trajectories cannot be read");
  folder.Write("run/trajectory.txt", "");
  AddPairFigures(folder / "data/euroc/a", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("rpe_pairs"), "no ground truth of two poses");
  EXPECT_TRUE(figures.values.empty());
}

TEST(PairFigures, OfAStartAreAMetreWithoutAPose) {
  const ScratchFolder folder;
  WriteRun(folder, 0.03, "stereo");
  RunFigures figures;
  figures.values["tracked"] = 3;
  AddPairFigures(folder / "data/euroc/a", folder / "run", figures);
  EXPECT_EQ(figures.values.at("start_rpe"), figures.values.at("rpe_pairs"));
  folder.Write("run/trajectory.txt", "");
  RunFigures without_truth;  // of the poses that the run has
  without_truth.values["tracked"] = 3;
  AddPairFigures(folder / "data/euroc/a", folder / "run", without_truth);
  EXPECT_EQ(without_truth.reasons.at("start_rpe"), "no ground truth of two poses");
  RunFigures without_map;
  without_map.values["tracked"] = 0;
  AddPairFigures(folder / "data/euroc/a", folder / "run", without_map);
  EXPECT_EQ(without_map.values.at("start_rpe"), 1000);
}

TEST(StartFigure, CountsTheFramesUntilTheFirstPose) {
  const ScratchFolder folder;
  RunFigures figures;
  AddStartFigure(folder.path(), figures);
  EXPECT_EQ(figures.reasons.at("start_frames"), "no frame has a pose");
  folder.Write("frames.csv", "frame,timestamp,state\n4,1.000,x\n5,1.050,x\n6,1.100,x\n");
  folder.Write("trajectory_causal.txt", "1.050 0 0 0 0 0 0 1\n1.100 1 0 0 0 0 0 1\n");
  AddStartFigure(folder.path(), figures);
  EXPECT_EQ(figures.values.at("start_frames"), 2);
  EXPECT_TRUE(figures.reasons.empty());
}

TEST(RunTrajectory, OfOneCameraIsAlignedWithItsScale) {
  const ScratchFolder folder;
  WriteRun(folder, 0, "mono");
  std::string run;
  for (int i = 0; i < 3; ++i) {
    run += fmt::format("{:.9f} {} {} 0 0 0 0 1\n", 1 + 0.05 * i, 3 * i, 0.001 * i * i);
  }
  folder.Write("run/trajectory.txt", run);
  const auto error = CompareRunWithTruth(folder / "data/euroc/a", folder / "run");
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->reference_from_estimate.scale, 1.0 / 3, 1e-3);
  EXPECT_LT(error->ate.rmse, 1e-3);
}

}  // namespace
}  // namespace plumbline
