// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_figures.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A sequence with a true line of 1 m, and a run whose world is 5 m beside that of the truth and
// whose map has the first half of the line.
RunFigures FiguresOf(const ScratchFolder& folder) {
  WriteSequenceFolder(folder, "s");
  folder.Write("s/mav0/state_groundtruth_estimate0/data.csv",
               "1000000000,0,0,0,1,0,0,0\n1050000000,1,0,0,1,0,0,0\n1100000000,0,1,0,1,0,0,0\n");
  folder.Write("s/lines.csv", "#x1,y1,z1,x2,y2,z2\n0,0,2,1,0,2\n");
  folder.Write("run/summary.json", Summary(0.01));
  folder.Write("run/trajectory.txt", "1.0 5 0 0 0 0 0 1\n1.05 6 0 0 0 0 0 1\n1.1 5 1 0 0 0 0 1\n");
  folder.Write("run/lines.obj", "v 5 0 2\nv 5.5 0 2\nl 1 2\n");
  return *ReadFigures(folder / "run");
}

TEST(LineMapFigures, CompareTheMapInTheWorldOfTheTruth) {
  const ScratchFolder folder;
  RunFigures figures = FiguresOf(folder);
  EXPECT_FALSE(figures.values.contains("line_recall"));
  AddLineMapFigures(folder / "s", folder / "run", figures);
  EXPECT_NEAR(figures.values.at("line_recall"), 55, 1e-6);  // half a metre and 5 cm
  EXPECT_NEAR(figures.values.at("line_precision"), 100, 1e-6);
  EXPECT_NEAR(figures.values.at("line_distance"), 0, 1e-3);
  EXPECT_NEAR(figures.values.at("line_angle"), 0, 1e-3);
  EXPECT_NEAR(figures.values.at("line_multiplicity"), 1, 1e-6);
  EXPECT_FALSE(figures.reasons.contains("line_recall"));
}

TEST(LineMapFigures, AskForWhatTheKeyFramesSee) {
  const ScratchFolder folder;
  RunFigures figures = FiguresOf(folder);
  folder.Write("run/keyframes.txt", "1.0 5 0 0 0 0 0 1\n1.05 6 0 0 0 0 0 1\n1.1 5 1 0 0 0 0 1\n");
  AddLineMapFigures(folder / "s", folder / "run", figures);
  EXPECT_FALSE(figures.values.contains("line_recall"));  // three keyframes are too few
  EXPECT_NEAR(figures.values.at("line_precision"), 100, 1e-6);
}

TEST(LineMapFigures, SayWhyThereAreNone) {
  const ScratchFolder folder;
  const RunFigures before = FiguresOf(folder);
  RunFigures figures = before;
  folder.Write("run/lines.obj", "");
  AddLineMapFigures(folder / "s", folder / "run", figures);
  EXPECT_EQ(figures.values.at("line_recall"), 0);
  EXPECT_EQ(figures.reasons.at("line_precision"), "no line has a counterpart");
  figures = before;
  folder.Write("s/lines.csv", "#x1\n1\n");
  AddLineMapFigures(folder / "s", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("line_recall"), "the lines cannot be read");
  figures = before;
  std::filesystem::remove(folder / "s/lines.csv");
  AddLineMapFigures(folder / "s", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("line_recall"), "the true lines are not known");
}

}  // namespace
}  // namespace plumbline
