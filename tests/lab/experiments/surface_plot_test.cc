// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/surface_plot.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SurfacePlot, IsLighterWhereTheValueIsGreater) {
  Eigen::MatrixXd values(4, 4);
  values << 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3;
  const Figure figure = SurfacePlot(values, {1, 0.5}, "log det", "first", "second");
  std::vector<Figure::Polyline> cells;
  for (const auto& line : figure.lines) {
    if (line.width > 50) cells.push_back(line);
  }
  ASSERT_EQ(cells.size(), 16U);
  for (std::size_t i = 0; i < 16; ++i) {
    if (i % 4 == 0) continue;
    EXPECT_GT(cells[i].color.r, cells[i - 1].color.r);
    EXPECT_DOUBLE_EQ(cells[i].points[0].x(), cells[i - 1].points[1].x());
  }
  EXPECT_GT(cells[0].points[0].y(), cells[15].points[0].y()) << "upwards";
  // The cross at the right edge, half way up.
  const auto& arm = figure.lines.back().points;
  EXPECT_NEAR(0.5 * (arm[0] + arm[1]).x(), cells[3].points[1].x(), 1e-9);
}

TEST(SurfacePlot, DrawsARowOfOneShadeAsOneLine) {
  const Figure figure = SurfacePlot(Eigen::MatrixXd::Ones(10, 10), {0, 0}, "", "", "");
  EXPECT_EQ(
      std::count_if(
          figure.lines.begin(), figure.lines.end(), [](auto& line) { return line.width > 30; }),
      10);
}

}  // namespace
}  // namespace plumbline
