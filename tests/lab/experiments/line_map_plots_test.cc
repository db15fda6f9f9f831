// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_plots.h"

#include "lab/experiments/paper_plots.h"

#include "tests/io/scratch_folder.h"
#include "tests/io/write_line_landmark.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline::line_map_plots_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kGreen = "rgb(20,140,50)\" stroke-width=\"0.9",
                           kRed = "rgb(215,30,30)\" stroke-width=\"0.9",
                           kBlack = "rgb(30,30,30)\" stroke-width=\"0.9";

int CountIn(const std::string& text, std::string_view part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// A sequence whose world has a line of 1 m; variant one has it as a landmark, that of two goes off
// 1 m beside it. Both run along the true path.
Plan PlanOfLines(const ScratchFolder& folder, PaperPlot plot) {
  WriteSequenceFolder(folder, "data/euroc/a");
  folder.Write("data/euroc/a/mav0/state_groundtruth_estimate0/data.csv",
               "1000000000,0,0,0,1,0,0,0\n1050000000,1,0,0,1,0,0,0\n1100000000,0,1,0,1,0,0,0\n");
  folder.Write("data/euroc/a/lines.csv", "#x1,y1,z1,x2,y2,z2\n0,0,2,1,0,2\n");
  Experiment experiment = TwoVariants();
  experiment.paper_plot = plot;
  experiment.runs = 1;
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  for (const Job& job : plan.jobs) {
    const std::string at = job.folder.lexically_relative(folder.path()).string();
    folder.Write(at + "/summary.json", "{\"sensor\": \"stereo\"}");
    folder.Write(at + "/trajectory.txt",
                 "1.0 0 0 0 0 0 0 1\n1.05 1 0 0 0 0 0 1\n1.1 0 1 0 0 0 0 1\n");
    const double y = job.variant == 0 ? 0 : 1;
    WriteLineLandmark(job.folder / "map.plb", {{0, y, 2}, {1, y, 2}});
  }
  return plan;
}

const std::vector<JobResult> kBoth = {Success(4, "a"), Success(4, "b")};

TEST(LineMapsPlot, ShowsTheLandmarksOfEachVariantByWhetherTheyAreRight) {
  const ScratchFolder folder;
  const Plan plan = PlanOfLines(folder, PaperPlot::kLineMaps);
  const std::string svg = LineMapsPlot(plan, kBoth, 0);
  EXPECT_THAT(svg, HasSubstr("one (1 lines)"));
  EXPECT_THAT(svg, HasSubstr("two (1 lines)"));
  EXPECT_THAT(svg, HasSubstr("from above"));
  EXPECT_THAT(svg, HasSubstr("from the side"));
  EXPECT_EQ(CountIn(svg, kGreen), 2);  // from above and from the side
  // From above it lies outside what the world's line spans.
  EXPECT_LE(CountIn(svg, kRed), 1);
  EXPECT_EQ(CountIn(svg, kBlack), 0);
  EXPECT_EQ(LineMapsPlot(plan, {NoResult("x"), NoResult("x")}, 0), "");
}

TEST(LineMapsPlot, IsBlackWhereTheTruthIsNotKnown) {
  const ScratchFolder folder;
  const Plan plan = PlanOfLines(folder, PaperPlot::kLineMaps);
  std::filesystem::remove(folder / "data/euroc/a/lines.csv");
  const std::string svg = LineMapsPlot(plan, kBoth, 0);
  EXPECT_EQ(CountIn(svg, kBlack), 4);
  EXPECT_THAT(svg, Not(HasSubstr("true line")));
}

TEST(LineAreaPlot, ShowsTheImageAndTheLinesOfTheKeyFramesNearestInTime) {
  const ScratchFolder folder;
  const Plan plan = PlanOfLines(folder, PaperPlot::kLineArea);
  const std::string svg = LineAreaPlot(plan, kBoth, 0);
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(svg, HasSubstr("from the camera"));
  EXPECT_EQ(CountIn(svg, kGreen), 2);
  EXPECT_EQ(CountIn(svg, kRed), 2);
}

TEST(PaperPlots, OfLinesLeaveOutVariantsWhoseMapCannotBeRead) {
  const ScratchFolder folder;
  for (const PaperPlot plot : {PaperPlot::kLineMaps, PaperPlot::kLineArea}) {
    const Plan plan = PlanOfLines(folder, plot);
    std::filesystem::remove(plan.jobs[1].folder / "map.plb");
    const auto plots = PaperPlots(plan, kBoth);
    ASSERT_EQ(plots.size(), 1U);
    EXPECT_EQ(plots[0].metric,
              plot == PaperPlot::kLineArea ? "line_area_euroc_a" : "line_maps_euroc_a");
    EXPECT_THAT(plots[0].svg, HasSubstr("one (1 lines)"));
    EXPECT_THAT(plots[0].svg, Not(HasSubstr("two")));
    std::filesystem::remove(plan.jobs[0].folder / "map.plb");
    EXPECT_TRUE(PaperPlots(plan, kBoth).empty());
  }
}

}  // namespace
}  // namespace plumbline::line_map_plots_test
