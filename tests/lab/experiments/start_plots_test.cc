// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/start_plots.h"

#include "tests/lab/experiments/start_fixtures.h"
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace start_plots_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> NamesOf(const std::vector<PagePlot>& plots) {
  std::vector<std::string> names;
  for (const PagePlot& plot : plots) names.push_back(plot.metric);
  return names;
}

TEST(StartPlots, ShowTimeAndErrorsOfThePoolsThereAre) {
  const ScratchFolder folder;
  const auto plots = StartPlots(PlanOfStarts(folder), StartsOfTwo());
  EXPECT_THAT(NamesOf(plots), ElementsAre("start_time", "start_errors"));
  EXPECT_THAT(plots[0].svg, HasSubstr("possible starts with a right map [%]: real"));
  EXPECT_THAT(plots[0].svg, Not(HasSubstr("synthetic")));
  EXPECT_THAT(plots[1].svg, HasSubstr("rotation error [deg]"));
  EXPECT_THAT(plots[1].svg, Not(HasSubstr("inverse depth error"))) << "never known";
}

TEST(StartPlots, GoOverTheAbscissaWhereThereIsOne) {
  const ScratchFolder folder;
  Plan plan = PlanOfStarts(folder);
  plan.experiment.abscissa = "frames";
  plan.experiment.variants[0].curve = plan.experiment.variants[1].curve = "method";
  plan.experiment.variants[0].abscissa = 3;
  plan.experiment.variants[1].abscissa = 7;
  const auto plots = StartPlots(plan, StartsOfTwo());
  EXPECT_THAT(NamesOf(plots), ElementsAre("success"));
  EXPECT_THAT(plots[0].svg, HasSubstr("frames"));
  EXPECT_THAT(plots[0].svg, HasSubstr("method"));
  EXPECT_THAT(plots[0].svg, Not(HasSubstr(">one<")));
}

}  // namespace start_plots_test
}  // namespace plumbline
