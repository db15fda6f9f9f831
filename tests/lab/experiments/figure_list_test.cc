// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/figure_list.h"

#include "tests/lab/experiments/experiment_fixtures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace figure_list_test {

TEST(FigureList, IsAListOfFiguresWithReasonsForWhatIsMissing) {
  const auto json = nlohmann::json::parse(FormatFigureList("bed", SomeFigures()));
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

}  // namespace figure_list_test
}  // namespace plumbline
