// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/find_lines.h"

#include "plumbline/features/match_lines.h"

#include "tests/features/render.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Three upright bars of different width and grey, displaced by `shift` pixels.
GrayImage Bars(double shift) {
  return Render(320, 240, [=](const Eigen::Vector2d& p) -> double {
    const double x = p.x() - shift;
    if (x > 60 && x < 90) return 200;
    if (x > 140 && x < 150) return 130;
    return x > 220 ? 250 : 40;
  });
}

TEST(FindLines, MakesLinesThatAnotherImageKnowsAgain) {
  const auto lines = FindLines(Bars(0));
  const auto moved = FindLines(Bars(7));
  ASSERT_EQ(lines.size(), 5U);
  ASSERT_EQ(moved.size(), 5U);
  const auto pairs = MatchLines(lines, moved, {});
  ASSERT_EQ(pairs.size(), 5U);
  for (const FeatureMatch& pair : pairs) {
    const double shift = moved[static_cast<std::size_t>(pair.b)].segment.Midpoint().x() -
                         lines[static_cast<std::size_t>(pair.a)].segment.Midpoint().x();
    EXPECT_NEAR(shift, 7, 0.2);
  }
}

TEST(FindLines, GivesNoMoreThanAskedFor) { EXPECT_EQ(FindLines(Bars(0), 2).size(), 2U); }

TEST(FindLines, FindsNothingInNoImage) { EXPECT_TRUE(FindLines(GrayImage()).empty()); }

}  // namespace
}  // namespace plumbline
