// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/dot_plot.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

std::vector<std::string> TextsOf(const Figure& figure) {
  std::vector<std::string> texts;
  for (const Figure::Text& text : figure.texts) texts.push_back(text.text);
  return texts;
}

// Of ATE.
Figure PlotOf(const std::vector<JobResult>& results) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  return DotPlot(plan, MakeTable(plan, results, MetricKind::kRepeatable), 0);
}

// The bars over the ranges, left and right end.
std::vector<std::pair<double, double>> BarsOf(const Figure& figure) {
  std::vector<std::pair<double, double>> bars;
  for (const Figure::Polyline& line : figure.lines) {
    if (line.width == 2 && line.points.size() == 2) {
      bars.emplace_back(line.points[0].x(), line.points[1].x());
    }
  }
  return bars;
}

double PlaceOf(const Figure& figure, const std::string& text) {
  const auto found = std::find_if(
      figure.texts.begin(), figure.texts.end(), [&](const auto& t) { return t.text == text; });
  return found == figure.texts.end() ? -1 : found->position.x();
}

const std::vector<JobResult> kResults = {Success(4, "a"),
                                         Success(6, "b"),
                                         Success(3, "c"),
                                         Success(3, "d"),
                                         Success(8, "e"),
                                         Success(10, "f"),
                                         NoResult("hangs"),
                                         NoResult("hangs")};

TEST(DotPlot, NamesWhatItShows) {
  EXPECT_THAT(
      TextsOf(PlotOf(kResults)),
      IsSupersetOf({"euroc/a", "euroc/b", "one", "two", "ate [mm]", "0", "2", "10", "2 failed"}));
}

TEST(DotPlot, BarsLieBetweenTheTicksOfTheirValues) {
  const Figure figure = PlotOf(kResults);
  const auto bars = BarsOf(figure);
  ASSERT_EQ(bars.size(), 3U);  // the fourth variant failed
  const double zero = PlaceOf(figure, "0"), pixel = (PlaceOf(figure, "10") - zero) / 10;
  EXPECT_NEAR(bars[0].first, zero + 4 * pixel, 1e-6);
  EXPECT_NEAR(bars[0].second, zero + 6 * pixel, 1e-6);
  EXPECT_NEAR(bars[1].second, zero + 3 * pixel, 1e-6);
  EXPECT_NEAR(bars[2].first, zero + 8 * pixel, 1e-6);
}

TEST(DotPlot, IsLogarithmicOverManyOrdersOnly) {
  std::vector<JobResult> results = kResults;
  results[5] = Success(1000, "f");
  const Figure figure = PlotOf(results);
  EXPECT_THAT(TextsOf(figure), IsSupersetOf({"ate [mm], logarithmic", "5", "10", "100", "1000"}));
  EXPECT_NEAR(PlaceOf(figure, "100") - PlaceOf(figure, "10"),
              PlaceOf(figure, "1000") - PlaceOf(figure, "100"),
              1e-6);
  results[5] = Success(0, "f");  // has no logarithm
  results[4] = Success(1000, "e");
  EXPECT_THAT(TextsOf(PlotOf(results)), Contains("ate [mm]"));
}

TEST(DotPlot, SaysWhichErrorsAreOfAPartOfTheFrames) {
  std::vector<JobResult> results = kResults;
  EXPECT_THAT(TextsOf(PlotOf(results)), Not(Contains(HasSubstr("of the frames"))));
  results[0] = Success(4, "a", 40);
  results[1] = Success(6, "b", 60);
  EXPECT_THAT(TextsOf(PlotOf(results)), Contains("of 50 % of the frames"));
}

TEST(DotPlot, IsDrawnEvenWithoutAnyValue) {
  const Figure figure = PlotOf(std::vector<JobResult>(8, NoResult("hangs")));
  EXPECT_THAT(TextsOf(figure), Contains("2 failed"));
  EXPECT_TRUE(BarsOf(figure).empty());
  EXPECT_THAT(TextsOf(figure), Not(Contains("nan")));
}

TEST(DotPlot, LiesWithinItsSize) {
  const Figure figure = PlotOf(kResults);
  for (const Figure::Polyline& line : figure.lines) {
    for (const Eigen::Vector2d& p : line.points) {
      EXPECT_TRUE(p.x() >= 0 && p.x() <= figure.width && p.y() >= 0 && p.y() <= figure.height);
    }
  }
}

}  // namespace
}  // namespace plumbline
