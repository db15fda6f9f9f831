// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_plots.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

bool HasText(const Figure& figure, const std::string& text) {
  return std::any_of(figure.texts.begin(), figure.texts.end(), [&](const Figure::Text& t) {
    return t.text.find(text) != std::string::npos;
  });
}

TEST(ConvergencePlot, HasACurveForEachMethodUpToTheErrorOfRunsWithoutAMap) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.runs = 1;
  experiment.variants = {{"m3", {}, {}, "frames/proposed", 3},
                         {"m5", {}, {}, "frames/proposed", 5},
                         {"two", {}, {}, "frames/conventional", 2},
                         {"p100", {}, {}, "points/proposed", 100},
                         {"p200", {}, {}, "points/proposed", 200}};
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  std::vector<JobResult> results(5, Success(4, "a"));
  for (JobResult& result : results) {
    result.figures->values["start_rpe"] = 20;
    result.figures->values["start_frames"] = 10;
  }
  results[4].figures->values["start_rpe"] = 1000;
  const Figure figure = ConvergencePlot(plan, results);
  EXPECT_TRUE(HasText(figure, "proposed"));
  EXPECT_TRUE(HasText(figure, "conventional"));
  EXPECT_TRUE(HasText(figure, "points in an image"));
  EXPECT_TRUE(HasText(figure, "1000")) << "the axis of the error reaches a metre";
}

// A run with a straight path and its truth.
Plan PlanWithPaths(const ScratchFolder& folder, PaperPlot plot) {
  WriteSequenceFolder(folder, "data/euroc/a");
  std::string truth = "#timestamp,px,py,pz,qw,qx,qy,qz\n", run;
  for (int i = 0; i < 3; ++i) {
    truth += fmt::format("{},{},{},0,1,0,0,0\n", 1'000'000'000 + 50'000'000LL * i, i, i * i);
    run += fmt::format("{:.9f} {} {} 0 0 0 0 1\n", 1 + 0.05 * i, i, i * i + 0.01);
  }
  folder.Write("data/euroc/a/mav0/state_groundtruth_estimate0/data.csv", truth);
  Experiment experiment = TwoVariants();
  experiment.paper_plot = plot;
  experiment.runs = 1;
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  for (const Job& job : plan.jobs) {
    const std::string at = job.folder.lexically_relative(folder.path()).string();
    folder.Write(at + "/trajectory.txt", run);
    folder.Write(at + "/summary.json", "{\"sensor\": \"stereo\"}");
  }
  return plan;
}

TEST(PathPlot, ShowsEveryVariantBesideTheTruth) {
  const ScratchFolder folder;
  const Plan plan = PlanWithPaths(folder, PaperPlot::kTrajectories);
  const Figure figure = PathPlot(plan, {Success(4, "a"), Success(4, "b")}, 0);
  for (const char* name : {"truth", "one", "two", "euroc/a"}) EXPECT_TRUE(HasText(figure, name));
  EXPECT_EQ(PathPlot(plan, {NoResult("x"), NoResult("x")}, 0).width, 0);
}

TEST(PaperPlots, AreNamedAfterSequenceAndVariantAndLeaveOutWhatCannotBeRead) {
  const ScratchFolder folder;
  const Plan paths = PlanWithPaths(folder, PaperPlot::kTrajectories);
  const auto plots = PaperPlots(paths, {Success(4, "a"), Success(4, "b")});
  ASSERT_EQ(plots.size(), 1U);
  EXPECT_EQ(plots[0].metric, "paths_euroc_a");
  EXPECT_THAT(plots[0].svg, HasSubstr("<svg"));
  // There is no map.plb.
  for (const PaperPlot plot : {PaperPlot::kRevisits, PaperPlot::kCutLines}) {
    const Plan plan = PlanWithPaths(folder, plot);
    EXPECT_TRUE(PaperPlots(plan, {Success(4, "a"), Success(4, "b")}).empty());
  }
  EXPECT_TRUE(PaperPlots(PlanWithPaths(folder, PaperPlot::kNone), {}).empty());
}

}  // namespace
}  // namespace plumbline
