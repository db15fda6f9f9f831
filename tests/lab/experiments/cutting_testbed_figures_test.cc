// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/cutting_testbed_figures.h"

#include "lab/experiments/figure_page.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Two cells of each kind with numbers that can be added up by hand.
TestbedTrials Trials() {
  TestbedTrials trials;
  for (const int lines : {6, 10}) {
    const SceneOptions options{SceneKind::kHomogeneousPoints, 0.005, lines};
    SingleLineCell single;
    single.options = options;
    single.trials = {{{0, 1}, {0, 1}, 0}, {{0.5, 0.5}, {0.3, 0.5}, lines == 6 ? 0.2 : 1e-4}};
    trials.single.push_back(single);
    JointTrial joint;
    for (const auto& [optimizer, name] : EnumNames(std::type_identity<JointOptimizer>{})) {
      joint.outcomes[optimizer] = {optimizer == JointOptimizer::kFull ? 10.0 : 12.0, 100};
    }
    joint.best = 12.005;
    trials.joint.push_back({options, {joint, joint}});
    PoseTrial pose;
    for (const auto& [variant, name] : EnumNames(std::type_identity<PoseVariant>{})) {
      pose[variant] = {variant == PoseVariant::kFull ? 0.02 : 0.01, 0.5};
    }
    trials.poses.push_back({options, {pose, pose, pose}});
  }
  trials.paths.push_back({{}, {{0, {}, {}}, {90, {0.1, 0.2, 0.3}, {0.7, 0.8, 0.9}}}});
  trials.surfaces.push_back({Eigen::MatrixXd::Identity(5, 5), {0, 1}});
  return trials;
}

double ValueOf(const std::vector<FigureRow>& rows,
               const std::string& sequence,
               const std::string& variant,
               const std::string& metric) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const FigureRow& r) {
    return r.sequence == sequence && r.variant == variant && r.metric == metric;
  });
  return row == rows.end() ? std::nan("") : row->value.value_or(std::nan(""));
}

TEST(CuttingTestbedFigures, CountSingleLines) {
  const auto rows = CuttingTestbedFigures(Trials());
  const std::string variant = "independent+three_starts";
  const std::string share = "share_within_0.01_of_brute_force";
  EXPECT_EQ(ValueOf(rows, "single/hp/0.005/6", variant, share), 50);
  EXPECT_EQ(ValueOf(rows, "single/hp/0.005/10", variant, share), 100);
  EXPECT_EQ(ValueOf(rows, "single/hp/0.005/all", variant, share), 75);
  EXPECT_EQ(ValueOf(rows, "single/all", variant, share), 75);
  EXPECT_EQ(ValueOf(rows, "single/all", variant, "share_ratios_within_0.01"), 50);
  EXPECT_EQ(ValueOf(rows, "single/all", variant, "share_point"), 50);
  EXPECT_EQ(ValueOf(rows, "single/all", variant, "worst_shortfall"), 0.2);
  EXPECT_EQ(ValueOf(rows, "single/all", variant, "cases"), 4);
}

TEST(CuttingTestbedFigures, CompareOptimizersWithFullLengthAndTheBest) {
  const auto rows = CuttingTestbedFigures(Trials());
  EXPECT_NEAR(ValueOf(rows, "joint/all", "ipopt", "mean_gain"), 2, 1e-9);
  EXPECT_NEAR(ValueOf(rows, "joint/all", "ipopt", "mean_shortfall"), 0.005, 1e-9);
  EXPECT_EQ(ValueOf(rows, "joint/all", "greedy", "share_within_0.01_of_best"), 100);
  EXPECT_EQ(ValueOf(rows, "joint/all", "full", "share_within_0.01_of_best"), 0);
  EXPECT_EQ(ValueOf(CuttingTestbedTimes(Trials()), "joint/all", "ipopt", "time_median"), 100);
}

TEST(CuttingTestbedFigures, CompareErrorsOfPosesWithWholeLines) {
  const auto rows = CuttingTestbedFigures(Trials());
  EXPECT_NEAR(ValueOf(rows, "pose/all", "cut", "translation_ratio"), 0.5, 1e-9);
  EXPECT_NEAR(ValueOf(rows, "pose/all", "cut", "translation_ratio_low"), 0.5, 1e-6);
  EXPECT_NEAR(ValueOf(rows, "pose/all", "full", "translation_error_median"), 20, 1e-9);
  EXPECT_NEAR(ValueOf(rows, "pose/hp/0.005/6", "cut", "rotation_error_median"), 0.5, 1e-9);
  EXPECT_TRUE(std::isnan(ValueOf(rows, "pose/hp/0.005/6", "cut", "motion_error")));
  TestbedTrials stereo = Trials();
  stereo.poses[0].options.kind = SceneKind::kStereo;
  stereo.poses[0].trials[0][PoseVariant::kCut].along_motion_m = -0.03;
  EXPECT_NEAR(ValueOf(CuttingTestbedFigures(stereo), "pose/stereo/0.005/6", "cut", "motion_error"),
              -10,
              1e-9);
}

TEST(CuttingTestbedFigures, UseDescribedMetricsOnly) {
  const auto rows = CuttingTestbedFigures(Trials());
  EXPECT_NO_THROW(FormatFigureMarkdown("t", "h", rows, CuttingTestbedMetrics()));
}

TEST(CuttingTestbedPlots, AreDrawings) {
  const auto plots = CuttingTestbedPlots(Trials());
  ASSERT_EQ(plots.size(), 5U);
  for (const PagePlot& plot : plots) {
    EXPECT_TRUE(plot.svg.starts_with("<svg")) << plot.metric;
    EXPECT_EQ(plot.svg.find("nan"), std::string::npos) << plot.metric;
  }
}

}  // namespace
}  // namespace plumbline
