// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table_page.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string PageOf(const Plan& plan, const std::vector<JobResult>& results) {
  return FormatPage(plan,
                    {MakeTable(plan, results, MetricKind::kRepeatable),
                     MakeTable(plan, results, MetricKind::kTiming)},
                    {{"ate", "<svg>drawn</svg>"}});
}

TEST(TablePage, HoldsTablesPlotsAndVariants) {
  const ScratchFolder folder;
  Plan plan = PlanOfTwo(folder);
  plan.missing = {"icl/*"};
  const std::string page = PageOf(plan,
                                  {Success(4, "a"),
                                   Success(5, "b"),
                                   Success(3, "c"),
                                   Success(3, "c"),
                                   NoResult("<hangs>"),
                                   NoResult("<hangs>"),
                                   Success(9, "f"),
                                   Success(10, "g")});
  for (const char* part : {"<title>pair</title>",
                           "<td>4.50 <span class=\"range\">(4.00-5.00)</span></td>",
                           "<td class=\"best\">3.00</td>",
                           "<td class=\"runs\">2 failed</td><td class=\"none\">-</td>",
                           "ate <span>mm</span></th>",
                           "<h2>Speed</h2>",
                           "<figure><svg>drawn</svg></figure>",
                           "<li><b>one</b>: <code>features.lines=false</code></li>",
                           "<li><b>two</b>: as it is</li>",
                           "<li>no sequence icl/*</li>",
                           "<li>failed: euroc/b, one, 2 runs: &lt;hangs&gt;</li>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
}

TEST(TablePage, NeedsNothingElse) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const std::string page = PageOf(plan, std::vector<JobResult>(8, Success(4, "a")));
  for (const char* part : {"http", "<script", "src=", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(part)));
  }
  EXPECT_THAT(page, Not(HasSubstr("What is missing")));
  // Every tag that is opened is closed.
  for (const std::string tag : {"table", "tr", "td", "th", "ul", "li", "figure", "p", "h2"}) {
    const auto count = [&page](const std::regex& pattern) {
      return std::distance(std::sregex_iterator(page.begin(), page.end(), pattern),
                           std::sregex_iterator());
    };
    EXPECT_EQ(count(std::regex("<" + tag + "[ >]")), count(std::regex("</" + tag + ">"))) << tag;
  }
}

TEST(FormatPage, ShowsTheErrorsAgainstAReference) {
  const ScratchFolder folder;
  Plan plan = PlanOfTwo(folder);
  plan.experiment.reference = "one";
  const std::vector<PairedRatio> ratios = {{0, 1, 2, 0, 1.5, 1.25, 1.75, 3}};
  const std::string page = FormatPage(plan, {}, {}, {ratios});
  EXPECT_NE(page.find("ATE against one"), std::string::npos);
  EXPECT_NE(page.find("1.500 (1.250-1.750)"), std::string::npos);
  EXPECT_EQ(FormatPage(plan, {}, {}).find("ATE against"), std::string::npos);
}

}  // namespace
}  // namespace plumbline
