// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/figure_list.h"

#include "plumbline/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::array kMetrics = {FigureMetric{"gain", "", "how much", 2},
                                 FigureMetric{"time", "us", "how <long>", 0}};

std::vector<FigureRow> Rows() {
  return {{"one/a", "cut", {}, "gain", 1.234, ""},
          {"one/a", "cut", {}, "time", 56.7, "us"},
          {"one/b", "whole", 3, "gain", {}, "", "no lines"},
          {"two/a", "cut", {}, "time", 8, "us"}};
}

TEST(FigureList, IsAListOfFiguresWithReasonsForWhatIsMissing) {
  const auto json = nlohmann::json::parse(FormatFigureList("bed", Rows()));
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[0]["experiment"], "bed");
  EXPECT_EQ(json[0]["value"], 1.234);
  EXPECT_TRUE(json[0]["seed"].is_null());
  EXPECT_FALSE(json[0].contains("reason"));
  EXPECT_EQ(json[1]["unit"], "us");
  EXPECT_EQ(json[2]["seed"], 3);
  EXPECT_TRUE(json[2]["value"].is_null());
  EXPECT_EQ(json[2]["reason"], "no lines");
}

TEST(FigureList, TablesHaveARowForEachSequenceAndVariant) {
  const std::string text = FormatFigureMarkdown("bed", "what it shows", Rows(), kMetrics);
  EXPECT_THAT(text,
              HasSubstr("## one\n\n| sequence | variant | gain | time [us] |\n|---|---|---|---|\n"
                        "| one/a | cut | 1.23 | 57 |\n| one/b | whole | - |  |\n"));
  EXPECT_THAT(text, HasSubstr("## two\n\n| sequence | variant | time [us] |"));
  EXPECT_THAT(text, HasSubstr("- **time [us]**: how <long>"));
}

TEST(FigureList, PageHoldsTablesAndPlotsAndNothingFromOutside) {
  const std::vector<PagePlot> plots = {{"shape", "<svg></svg>"}};
  const std::string page = FormatFigurePage("bed", "what", Rows(), kMetrics, plots);
  EXPECT_THAT(page, HasSubstr("<svg></svg>"));
  EXPECT_THAT(page, HasSubstr("<tr><th>one/a</th><td>cut</td><td>1.23</td><td>57</td></tr>"));
  EXPECT_THAT(page, HasSubstr("how &lt;long&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST(FigureList, RefusesMetricsWithoutADescription) {
  const std::vector<FigureRow> rows = {{"one/a", "cut", {}, "other", 1.0, ""}};
  EXPECT_THROW(FormatFigureMarkdown("bed", "what", rows, kMetrics), BugError);
}

}  // namespace
}  // namespace plumbline
