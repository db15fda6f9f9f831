// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_figures.h"

#include "tests/io/scratch_folder.h"
#include "tests/io/write_line_landmark.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

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

// The line is 1 m from (0, 0, 2) along x; the world of the run lies 5 m beside.
TEST(MapLineFigures, TakeTheLandmarksWithTheirOwnEnds) {
  const ScratchFolder folder;
  RunFigures figures = FiguresOf(folder);
  const auto figures_of = [&](const Segment3& landmark) {
    WriteLineLandmark(folder / "run/map.plb", landmark);
    AddLineMapFigures(folder / "s", folder / "run", figures);
    AddMapLineFigures(folder / "s", folder / "run", figures);
    return figures.values;
  };
  const auto right = figures_of({{5.2, 0, 2}, {6, 0, 2}});
  EXPECT_NEAR(right.at("map_line_precision"), 100, 1e-6);
  EXPECT_NEAR(right.at("map_line_recall"), 85, 1e-6);  // 80 cm and 5 cm
  EXPECT_NEAR(right.at("map_line_error"), 0, 1e-3);
  EXPECT_NEAR(right.at("map_line_angle"), 0, 1e-3);
  // An end pulled half a metre along the line: 0.85 of 1.3 m lie on the true one.
  const auto pulled = figures_of({{5.2, 0, 2}, {6.5, 0, 2}});
  EXPECT_NEAR(pulled.at("map_line_precision"), 100 * 0.85 / 1.3, 1e-6);
  EXPECT_NEAR(pulled.at("map_line_error"), 500, 1e-3);
  EXPECT_EQ(pulled.at("line_precision"), right.at("line_precision"));
  // 12 cm beside it.
  const auto beside = figures_of({{5.2, 0.12, 2}, {6, 0.12, 2}});
  EXPECT_NEAR(beside.at("map_line_precision"), 0, 1e-6);
  EXPECT_NEAR(beside.at("map_line_error"), 120, 1e-3);
  // Turned about one end: 1 m is off.
  const auto turned = figures_of({{5.2, 0, 2}, {5.2, 1, 2}});
  EXPECT_NEAR(turned.at("map_line_error"), 1000, 1e-3);
  EXPECT_EQ(figures.reasons.at("map_line_angle"), "no line has a counterpart");
  EXPECT_EQ(turned.at("line_recall"), right.at("line_recall"));
}

TEST(MapLineFigures, SayWhyThereAreNone) {
  const ScratchFolder folder;
  RunFigures figures = FiguresOf(folder);
  AddMapLineFigures(folder / "s", folder / "run", figures);
  EXPECT_EQ(figures.reasons.at("map_line_error"), "the lines cannot be read");
  EXPECT_TRUE(AsksForMapLines(std::vector<std::string>{"ate", "map_line_error"}));
  EXPECT_FALSE(AsksForMapLines(std::vector<std::string>{"line_precision", "map_line_bytes"}));
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
