// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/box_plot.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The lines of one width, left to right in each: whiskers 1.5, boxes 16.
std::vector<Figure::Polyline> LinesOf(const Figure& figure, double width) {
  std::vector<Figure::Polyline> lines;
  for (const auto& line : figure.lines) {
    if (line.width == width) lines.push_back(line);
  }
  return lines;
}

TEST(BoxPlot, DrawsQuartilesToScale) {
  const Figure figure = BoxPlot("gain", {{"a", {0, 1, 2, 3, 4}}, {"b", {8, 8, 8}}, {"c", {}}});
  const auto boxes = LinesOf(figure, 16);
  ASSERT_EQ(boxes.size(), 2U);
  const auto whisker = LinesOf(figure, 1.5).front().points;
  const double scale = (whisker[1].x() - whisker[0].x()) / 4;
  EXPECT_NEAR(boxes[0].points[0].x(), whisker[0].x() + scale, 1e-6);
  EXPECT_NEAR(boxes[0].points[1].x(), whisker[0].x() + 3 * scale, 1e-6);
  EXPECT_NEAR(boxes[1].points[0].x(), whisker[0].x() + 8 * scale, 1e-6);
  EXPECT_EQ(boxes[1].points[0].x(), boxes[1].points[1].x());
  const auto says = [&](const std::string& text) {
    return std::any_of(
        figure.texts.begin(), figure.texts.end(), [&](auto& t) { return t.text == text; });
  };
  EXPECT_TRUE(says("a"));
  EXPECT_TRUE(says("gain"));
  EXPECT_FALSE(says("c"));
}

TEST(BoxPlot, IsEmptyWithoutValues) { EXPECT_TRUE(BoxPlot("gain", {{"a", {}}}).lines.empty()); }

}  // namespace
}  // namespace plumbline
