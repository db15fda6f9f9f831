// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/figure_page.h"

#include "plumbline/base/error.h"

#include "tests/lab/experiments/experiment_fixtures.h"
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace figure_page_test {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::array kMetrics = {FigureMetric{"gain", "", "how much", 2},
                                 FigureMetric{"time", "us", "how <long>", 0}};

TEST(FigurePage, TablesHaveARowForEachSequenceAndVariant) {
  const std::string text = FormatFigureMarkdown("bed", "what it shows", SomeFigures(), kMetrics);
  EXPECT_THAT(text,
              HasSubstr("## one\n\n| sequence | variant | gain | time [us] |\n|---|---|---|---|\n"
                        "| one/a | cut | 1.23 | 57 |\n| one/b | whole | - |  |\n"));
  EXPECT_THAT(text, HasSubstr("## two\n\n| sequence | variant | time [us] |"));
  EXPECT_THAT(text, HasSubstr("- **time [us]**: how <long>"));
}

TEST(FigurePage, PageHoldsTablesAndPlotsAndNothingFromOutside) {
  const std::vector<PagePlot> plots = {{"shape", "<svg></svg>"}};
  const std::string page = FormatFigurePage("bed", "what", SomeFigures(), kMetrics, plots);
  EXPECT_THAT(page, HasSubstr("<svg></svg>"));
  EXPECT_THAT(page, HasSubstr("<tr><th>one/a</th><td>cut</td><td>1.23</td><td>57</td></tr>"));
  EXPECT_THAT(page, HasSubstr("how &lt;long&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST(FigurePage, RefusesMetricsWithoutADescription) {
  const std::vector<FigureRow> rows = {{"one/a", "cut", {}, "other", 1.0, ""}};
  EXPECT_THROW(FormatFigureMarkdown("bed", "what", rows, kMetrics), BugError);
}

}  // namespace figure_page_test
}  // namespace plumbline
